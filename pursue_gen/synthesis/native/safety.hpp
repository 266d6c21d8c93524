// Safety: the least fixpoint of losing positions, L.
#pragma once

#include <memory>

#include "fixpoint.hpp"

namespace pursue {

template <class Z>
class Safety : public Fixpoint<Z> {
  public:
    using Fixpoint<Z>::Fixpoint;

    enum class Verdict { open, won, lost };

    // Goes on for a while. "Won" and "lost" are final. A search with few moves of the controller that loses says "open",
    // as they may be too few, and is `finished`.
    Verdict go_on(double work) {
        if (this->nodes_.empty() && !begin()) return Verdict::lost;
        if (this->settle(work)) return lost();
        if (!this->settled()) return Verdict::open;
        if (this->few_ == Few::controllers || this->all_) return Verdict::won;
        open_all();
        return Verdict::open;
    }

    // A look at the game that decides it if it is small.
    Verdict glance(double work) {
        constexpr double per_state = 24;
        if (!this->start()) return Verdict::lost;
        wake_all(this->explore(static_cast<std::size_t>(work / per_state)));
        if (!this->touched_.empty()) return Verdict::open;
        if (this->settle(work)) return Verdict::lost;
        return this->settled() ? Verdict::won : Verdict::open;
    }

    bool finished() const { return finished_; }

    // Safe points: where waiting for ever is safe, wait; else the command that a relaxed plan likes, else any safe one.
    std::vector<Action<Z>> plan(int k) override {
        Node<Z>& n = nodes_[k];
        std::vector<Action<Z>> out;
        if (n.lost || n.rest.empty()) return out;
        const Federation<Z> harmful = this->harm(n);
        auto usable = this->commands(n, harmful);
        const std::vector<int> liked = this->policy_.liked(this->state(k));
        const auto rank = [&](int joint) { return std::find(liked.begin(), liked.end(), this->joint(joint).edges[0]) - liked.begin(); };
        std::stable_sort(usable.begin(), usable.end(), [&](const auto& a, const auto& b) { return rank(a.first) < rank(b.first); });
        Federation<Z> evil = harmful;
        append(evil, obliged(n));
        const Federation<Z> duty = pasts(evil);  // from here the controller has to act some time
        Federation<Z> safe = n.rest, urgent = reduced(intersection(duty, safe));
        for (const auto& [joint, zones] : usable) {
            const Federation<Z> here = disjoint(intersection(urgent, minus(zones, harmful)));
            for (const Z& z : here) out.push_back({z, joint, 0});
            urgent = minus(urgent, here);
            safe = minus(safe, here);
        }
        for (const Z& z : disjoint(safe)) out.push_back({z, -1, 0});
        return out;
    }

  private:
    using Fixpoint<Z>::nodes_, Fixpoint<Z>::game_, Fixpoint<Z>::joints_;

    bool begin() {
        if (!this->start()) return false;
        wake_all(this->explore());
        return true;
    }

    // What leads to a loss is looked at after what it leads to.
    void wake_all(const std::vector<int>& states) {
        for (auto k = states.rbegin(); k != states.rend(); ++k) this->wake(*k);
    }

    Verdict lost() {
        finished_ = true;
        return this->few_ == Few::controllers ? Verdict::open : Verdict::lost;
    }

    // What is lost against few moves of the environment is lost against all of them, so the fixpoint goes on.
    void open_all() {
        this->all_ = true;
        for (std::size_t k = 0, count = nodes_.size(); k < count; ++k)
            if (nodes_[k].reached) this->expand(static_cast<int>(k), true);
        wake_all(this->explore());
    }

    bool finished_ = false;

    // Stuck before escapes are taken off: at the bound of an automaton that the environment cannot move.
    Federation<Z> obliged(const Node<Z>& n) const {
        Federation<Z> out;
        int last = -1;
        for (const auto& [a, bound] : n.limits) {
            if (a != last) append(out, minus(this->at_bound(n, a), this->own_moves(n, a)));
            last = a;
        }
        return out;
    }

    static Federation<Z> pasts(const Federation<Z>& zones) {
        Federation<Z> out;
        for (Z z : zones) {
            down(z);
            insert(out, z);
        }
        return out;
    }

    // Some of it is lost.
    bool decided(const Federation<Z>& rest, const Z& start) const override { return !contains(rest, start); }

    const Federation<Z>& winning(Node<Z>& n) const override { return n.rest; }
    const Federation<Z>& losing(Node<Z>& n) const override { return this->gathered(n); }

    // Of what is not lost yet: past(E) \ Predt(cPre(not L), E). L need not be in E: whoever comes to L by waiting
    // comes to what made it losing.
    bool evaluate(Node<Z>& n) override {
        if (n.rest.empty()) return false;
        if (n.lost) return this->decide_all(n);
        const Federation<Z> harmful = this->harm(n), bound = obliged(n);
        if (harmful.empty() && bound.empty()) return false;
        Federation<Z> escapes;
        for (const auto& [joint, zones] : this->commands(n, harmful)) append(escapes, zones);
        Federation<Z> evil = minus(bound, escapes);
        append(evil, harmful);
        const Federation<Z> danger = pasts(evil), ways = predt(minus(escapes, evil), evil);
        this->work_ += static_cast<double>(n.rest.size() + evil.size()) * static_cast<double>(danger.size() + ways.size());
        Federation<Z> lost, rest, cut;
        for (const Z& r : n.rest) {
            Federation<Z> gone;
            if (touches(danger, r))
                for (const Z& z : intersection(danger, minus(Federation<Z>{r}, ways))) absorb(gone, z);
            if (gone.empty()) {
                rest.push_back(r);
                continue;
            }
            append(cut, minus(Federation<Z>{r}, gone));
            append(lost, gone);
        }
        if (lost.empty()) return false;
        for (const Z& z : cut) absorb(rest, z);
        n.rest = std::move(rest);
        append(n.fresh, lost);
        return true;
    }
};

// Small games, for which `moment` is enough work, are decided as they are. Otherwise two searches take turns, each with twice the work of its turn before: one
// keeps the controller to few moves, so that what it wins is won; the other keeps the environment to few, so that what it
// loses is lost, and plays the whole game when those are not enough.
template <class Z>
std::pair<bool, std::unique_ptr<Safety<Z>>> solve_safety(const Game& game, const Limits& limits, double moment) {
    using Verdict = typename Safety<Z>::Verdict;
    auto glance = std::make_unique<Safety<Z>>(game, limits, Few::nobodys);
    const Verdict seen = glance->glance(moment);
    if (seen != Verdict::open) return {seen == Verdict::won, std::move(glance)};
    glance.reset();
    auto careful = std::make_unique<Safety<Z>>(game, limits, Few::controllers);
    auto whole = std::make_unique<Safety<Z>>(game, limits, Few::environments);
    for (double work = std::max(moment, 1.0);; work *= 2) {
        if (careful && careful->go_on(work) == Verdict::won) return {true, std::move(careful)};
        if (careful && careful->finished()) careful.reset();
        const Verdict verdict = whole->go_on(work);
        if (verdict != Verdict::open) return {verdict == Verdict::won, std::move(whole)};
    }
}

}  // namespace pursue
