// Safety: the least fixpoint of losing positions, L.
#pragma once

#include <memory>

#include "fixpoint.hpp"

namespace pursue {

template <class Z>
class Safety : public Fixpoint<Z> {
  public:
    enum class Verdict { open, won, lost };

    static constexpr double per_state = 24;  // the work of a budget that exploring a state stands for

    // `most`: in so many zones at most is kept, in each discrete state, what is lost; 0: in as many as it takes. Fewer zones
    // hold more points, so what is won is won, and what is lost may only be lost so.
    Safety(const Game& game, LimitMonitor& monitor, Restricted restricted, std::size_t most = 0)
        : Fixpoint<Z>(game, monitor, restricted), most_(most) {}

    // Goes on until the budget is used up. `won` and `lost` are final. A search with few moves of the controller that loses
    // returns `open`, as they may be too few, and is `finished`.
    Verdict resume(double budget) {
        if (this->nodes_.empty() && !explore_from_start()) return Verdict::lost;
        if (this->iterate(budget)) return lost();
        if (!this->converged()) return Verdict::open;
        if (this->restricted_ == Restricted::controllable || this->all_) return Verdict::won;
        open_all();
        return Verdict::open;
    }

    // Tries the game as it is: decides it if it is small.
    Verdict try_small(double budget) {
        if (!this->enter_start()) return Verdict::lost;
        schedule_all(this->explore(static_cast<std::size_t>(budget / per_state)));
        if (!this->queue_.empty()) return Verdict::open;
        if (this->iterate(budget)) return Verdict::lost;
        return this->converged() ? Verdict::won : Verdict::open;
    }

    bool finished() const { return finished_; }
    double work() const { return this->work_; }  // of the last `resume`

    // Begins again, with what is lost in more zones (0: as many as it takes).
    void refine(std::size_t most) {
        most_ = most;
        finished_ = false;
        std::vector<int> all;
        for (std::size_t k = 0; k < nodes_.size(); ++k) {
            Node<Z>& n = nodes_[k];
            if (!n.reached) continue;
            n.done.clear();
            n.fresh.clear();
            n.rest = {n.hull};
            all.push_back(static_cast<int>(k));
        }
        schedule_all(all);
    }

    // Safe points: where waiting for ever is safe, wait; else the command that a relaxed plan prefers, else any safe one.
    std::vector<Piece<Z>> plan(int k) override {
        Node<Z>& n = nodes_[k];
        std::vector<Piece<Z>> out;
        if (n.lost || n.rest.empty()) return out;
        const Federation<Z> unsafe = this->upre(n);
        auto usable = this->cpre(n, unsafe);
        const std::vector<int> preferred = this->policy_.preferred(this->state(k));
        const auto place = [&](const auto& command) {
            const int edge = this->joint(command.first).edges[0];
            return std::find(preferred.begin(), preferred.end(), edge) - preferred.begin();
        };
        std::stable_sort(usable.begin(), usable.end(), [&](const auto& a, const auto& b) { return place(a) < place(b); });
        Federation<Z> to_avoid = unsafe;
        append(to_avoid, time_blocked(n));
        const Federation<Z> must_act = pasts(to_avoid);  // from here the controller has to act some time
        Federation<Z> safe = most_ ? disjoint(minus(Federation<Z>{n.hull}, dangers(n, unsafe, usable).lost())) : n.rest;
        Federation<Z> urgent = reduced(intersection(must_act, safe));
        for (const auto& [joint, zones] : usable) {
            const Federation<Z> here = disjoint(intersection(urgent, minus(zones, unsafe)));
            for (const Z& z : here) out.push_back({z, joint, 0});
            urgent = minus(urgent, here);
            safe = minus(safe, here);
        }
        for (const Z& z : disjoint(safe)) out.push_back({z, -1, 0});
        return out;
    }

  private:
    using Fixpoint<Z>::nodes_, Fixpoint<Z>::game_, Fixpoint<Z>::joints_;

    bool explore_from_start() {
        if (!this->enter_start()) return false;
        schedule_all(this->explore());
        return true;
    }

    // What leads to a loss is evaluated after what it leads to.
    void schedule_all(const std::vector<int>& states) {
        for (auto k = states.rbegin(); k != states.rend(); ++k) this->schedule(*k);
    }

    Verdict lost() {
        finished_ = true;
        return this->restricted_ == Restricted::controllable ? Verdict::open : Verdict::lost;
    }

    // What is lost against few moves of the environment is lost against all of them, so the fixpoint goes on.
    void open_all() {
        this->all_ = true;
        for (std::size_t k = 0, count = nodes_.size(); k < count; ++k) {
            this->check_limits();
            if (nodes_[k].reached) this->expand(static_cast<int>(k), true);
        }
        schedule_all(this->explore());
    }

    // What is to be avoided, from where time leads there, and from where a move comes before.
    struct Dangers {
        Federation<Z> to_avoid, past, ways;

        Federation<Z> lost() const { return minus(past, ways); }
    };

    Dangers dangers(Node<Z>& n, const Federation<Z>& unsafe, const typename Fixpoint<Z>::Usable& usable) const {
        const Federation<Z>& bound = time_blocked(n);
        if (unsafe.empty() && bound.empty()) return {};
        Federation<Z> escapes;
        for (const auto& [joint, zones] : usable) append(escapes, zones);
        Federation<Z> to_avoid = minus(bound, escapes);
        append(to_avoid, unsafe);
        Federation<Z> ways = predt(minus(escapes, to_avoid), to_avoid);
        return {to_avoid, pasts(to_avoid), std::move(ways)};
    }

    std::size_t most_;
    bool finished_ = false;

    // Stuck before escapes are taken off: at the bound of an automaton that the environment cannot move.
    const Federation<Z>& time_blocked(Node<Z>& n) const {
        return this->at_bounds(n, [&](int a) { return minus(this->at_bound(n, a), this->own_moves(n, a)); });
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
    bool evaluate(int k) override {
        Node<Z>& n = nodes_[k];
        if (n.rest.empty()) return false;
        if (n.lost) return this->decide_all(n);
        const Federation<Z> unsafe = this->upre(n);
        const Dangers found = dangers(n, unsafe, this->cpre(n, unsafe));
        if (found.to_avoid.empty()) return false;
        const Federation<Z>&danger = found.past, &ways = found.ways;
        this->work_ += static_cast<double>(n.rest.size() + found.to_avoid.size()) *
                       static_cast<double>(danger.size() + ways.size());
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
        if (most_) return lose(n, lost);
        for (const Z& z : cut) absorb(rest, z);
        n.rest = std::move(rest);
        append(n.fresh, lost);
        return true;
    }

    // Adds to what is lost, in as many zones as it may have.
    bool lose(Node<Z>& n, const Federation<Z>& lost) {
        for (const Z& z : lost) absorb(n.done, z);
        if (n.done.size() > most_) n.done = {boxed(n.hull, n.done)};
        n.rest = {n.hull};
        for (const Z& z : n.done) n.rest = reduced(intersection(n.rest, around(n.hull, z)));
        return true;
    }
};

// Small games, for which `small_budget` is enough work, are decided as they are. Otherwise two searches take turns, each
// with twice the work of its turn before: one keeps the controller to few moves and what is lost to few zones, more where
// it loses, so that what it wins is won; the other keeps the environment to few, so that what it loses is lost, and plays the
// whole game when those are not enough. It has to explore all states before it evaluates one, which later turns pay for as
// long as there are two searches.
template <class Z>
std::pair<bool, std::unique_ptr<Safety<Z>>> solve_safety(const Game& game, LimitMonitor& monitor,
                                                         double small_budget) {
    using Verdict = typename Safety<Z>::Verdict;
    constexpr std::size_t largest = 8;
    auto small = std::make_unique<Safety<Z>>(game, monitor, Restricted::none);
    const Verdict first = small->try_small(small_budget);
    if (first != Verdict::open) return {first == Verdict::won, std::move(small)};
    small.reset();
    std::size_t most = 1;  // zones of what is lost
    auto winning = std::make_unique<Safety<Z>>(game, monitor, Restricted::controllable, most);
    auto losing = std::make_unique<Safety<Z>>(game, monitor, Restricted::uncontrollable);
    double given = 0, used = 0;  // work for `losing`, and its work
    for (double budget = std::max(small_budget, 1.0);; budget *= 2) {
        for (double left = budget; winning && left > 0; left -= std::max(winning->work(), 1.0)) {
            const Verdict verdict = winning->resume(left);
            if (verdict == Verdict::won) return {true, std::move(winning)};
            if (!winning->finished()) break;
            if (most) winning->refine(most = most < largest ? 2 * most : 0);
            else winning.reset();
            if (!winning) break;
        }
        given += budget;
        if (winning && used >= given) continue;
        const std::size_t before = losing->symbolic_states();
        const Verdict verdict = losing->resume(budget);
        used += losing->work() + Safety<Z>::per_state * static_cast<double>(losing->symbolic_states() - before);
        if (verdict != Verdict::open) return {verdict == Verdict::won, std::move(losing)};
    }
}

}  // namespace pursue
