// Reach, and reach while safe: the least fixpoint of winning positions, W.
#pragma once

#include "fixpoint.hpp"

namespace pursue {

template <class Z>
class Reach : public Fixpoint<Z> {
  public:
    Reach(const Game& game, const Limits& limits) : Fixpoint<Z>(game, limits, Restricted::controllable) {}

    // Whether the controller wins. With few moves first; after a loss, states that are not won get all of theirs.
    bool run() {
        if (!this->enter_start()) return false;
        while (true) {
            for (int k : this->explore()) this->schedule(k);
            if (this->iterate()) return true;
            const std::size_t count = nodes_.size();
            for (std::size_t k = 0; k < count; ++k)
                if (nodes_[k].reached && !nodes_[k].rest.empty()) this->expand(static_cast<int>(k), true);
            if (this->queue_.empty()) return false;
        }
    }

    std::vector<Piece<Z>> plan(int k) override { return nodes_[k].plan; }

  private:
    using Fixpoint<Z>::nodes_, Fixpoint<Z>::game_;

    // All of it is won.
    bool decided(const Federation<Z>& rest, const Z& start) const override {
        return intersection(rest, Federation<Z>{start}).empty();
    }

    const Federation<Z>& winning(Node<Z>& n) const override { return this->gathered(n); }
    const Federation<Z>& losing(Node<Z>& n) const override { return n.rest; }

    bool evaluate(Node<Z>& n) override {
        if (n.lost) return false;
        if (n.won) return this->decide_all(n);
        const auto won = [&](const Transition& transition) {
            const Node<Z>& target = nodes_[transition.target];
            return !target.done.empty() || !target.fresh.empty();
        };
        if (n.rest.empty() || std::none_of(n.transitions.begin(), n.transitions.end(), won)) return false;
        const Federation<Z> unsafe = this->upre(n);
        const auto usable = this->cpre(n, unsafe);
        // X need not be added: whoever can wait for X can wait for what made X winning.
        Federation<Z> good = minus(forced(n), unsafe);
        for (const auto& [joint, zones] : usable) append(good, zones);
        const Federation<Z> fresh = reduced(intersection(predt(good, unsafe), n.rest));
        if (fresh.empty()) return false;
        Federation<Z> rest, cut;
        for (const Z& r : n.rest)
            if (touches(fresh, r)) append(cut, minus(Federation<Z>{r}, fresh));
            else rest.push_back(r);
        for (const Z& z : cut) absorb(rest, z);
        n.rest = std::move(rest);
        record_commands(n, fresh, usable, unsafe);
        append(n.fresh, fresh);
        return true;
    }

    // F before uPre is taken off: where an automaton of the environment is at its bound, and has to move.
    Federation<Z> forced(const Node<Z>& n) const {
        Federation<Z> out;
        int last = -1;
        for (const auto& [a, bound] : n.limits) {
            if (a != last) append(out, intersection(this->own_moves(n, a), this->at_bound(n, a)));
            last = a;
        }
        return out;
    }

    // Adds what to do at points that are won now.
    void record_commands(Node<Z>& n, const Federation<Z>& fresh, const typename Fixpoint<Z>::Usable& usable,
                         const Federation<Z>& unsafe) {
        Federation<Z> rest = fresh;
        for (const auto& [joint, zones] : usable) {
            const Federation<Z> now = minus(zones, unsafe);
            for (const Z& z : disjoint(intersection(rest, now))) n.plan.push_back({z, joint, rank_});
            rest = minus(rest, now);
        }
        for (const Z& z : disjoint(rest)) n.plan.push_back({z, -1, rank_});
        ++rank_;
    }

    int rank_ = 1;
};

}  // namespace pursue
