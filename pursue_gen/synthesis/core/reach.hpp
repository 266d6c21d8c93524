// Reach, and reach while safe: the least fixpoint of winning positions, W.
#pragma once

#include "fixpoint.hpp"

namespace pursue {

template <class Z>
class Reach : public Fixpoint<Z> {
  public:
    using Fixpoint<Z>::Fixpoint;

    // With few moves first; after a loss, states that are not won get all of theirs.
    bool run() override {
        if (!this->start()) return false;
        while (true) {
            for (int k : this->explore()) this->wake(k);
            if (this->settle()) return true;
            const std::size_t count = nodes_.size();
            for (std::size_t k = 0; k < count; ++k)
                if (nodes_[k].reached && !nodes_[k].rest.empty()) this->expand(static_cast<int>(k), true);
            if (this->touched_.empty()) return false;
        }
    }

    std::vector<Action<Z>> plan(int k) override { return nodes_[k].plan; }

  private:
    using Fixpoint<Z>::nodes_, Fixpoint<Z>::game_;

    bool evaluate(Node<Z>& n) override {
        if (n.lost) return false;
        if (n.won) return this->fill(n);
        const auto won = [&](const Step& step) { return !nodes_[step.target].set.empty(); };
        if (n.rest.empty() || std::none_of(n.steps.begin(), n.steps.end(), won)) return false;
        const Federation<Z> harmful = this->harm(n, &Node<Z>::rest);
        const auto usable = this->commands(n, harmful, &Node<Z>::set);
        Federation<Z> good = n.set;
        for (const auto& [joint, zones] : usable) append(good, zones);
        append(good, minus(forced(n), harmful));
        const Federation<Z> fresh = reduced(intersection(predt(good, harmful), n.rest));
        if (fresh.empty()) return false;
        advise(n, fresh, usable, harmful);
        this->take(n, fresh);
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

    // What to do at points that are won now.
    void advise(Node<Z>& n, const Federation<Z>& fresh, const typename Fixpoint<Z>::Usable& usable, const Federation<Z>& harmful) {
        Federation<Z> rest = fresh;
        for (const auto& [joint, zones] : usable) {
            const Federation<Z> now = minus(zones, harmful);
            for (const Z& z : reduced(intersection(rest, now))) n.plan.push_back({z, joint, rank_});
            rest = minus(rest, now);
        }
        for (const Z& z : reduced(rest)) n.plan.push_back({z, -1, rank_});
        ++rank_;
    }

    int rank_ = 1;
};

}  // namespace pursue
