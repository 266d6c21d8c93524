// Reach, and reach while safe: the least fixpoint of winning positions, W.
#pragma once

#include <memory>
#include <numeric>

#include "fixpoint.hpp"

namespace pursue {

template <class Z>
class Reach : public Fixpoint<Z> {
  public:
    enum class Verdict { open, won, lost };

    // `most`: in so many zones at most is kept, in each discrete state, what is not won; 0: in as many as it takes. Fewer
    // zones hold more points, so what is won is won, and what is lost may only be lost so. `soonest`: with all moves, and
    // what is won sooner in time first.
    Reach(const Game& game, LimitMonitor& monitor, std::size_t most, bool soonest = false)
        : Fixpoint<Z>(game, monitor, soonest ? Restricted::none : Restricted::controllable), most_(most),
          soonest_(soonest) {
        this->all_ = soonest;
    }

    // Goes on until the budget is used up, with few moves first; after a loss, states that are not won get all of theirs.
    // `won` and `lost` are final.
    Verdict resume(double budget) {
        if (nodes_.empty() && !this->enter_start()) return Verdict::lost;
        spent_ = 0;
        const auto end = this->symbolic_states() + static_cast<std::size_t>(budget / per_state);
        while (true) {
            for (int k : this->explore(end)) this->schedule(k);
            if (!this->queue_.empty()) return Verdict::open;
            const bool won = this->iterate(budget - spent_);
            spent_ += this->work_;
            evaluated_ += this->work_;
            if (won) return Verdict::won;
            if (!this->converged()) return Verdict::open;
            if (!open_states()) return Verdict::lost;
        }
    }

    double work() const { return spent_; }  // of the last `resume`

    // Whether an evaluation took so few zones, on average, that one which keeps fewer would hardly take less.
    bool is_cheap() const { return evaluated_ <= cheap * static_cast<double>(this->evaluations()); }

    // Keeps what is not won in more zones from now on.
    void refine(std::size_t most) {
        most_ = most;
        for (std::size_t k = 0; k < nodes_.size(); ++k)
            if (nodes_[k].coarse) this->schedule(static_cast<int>(k));
    }

    // The points in the order in which they were won; first won, first served.
    std::vector<Piece<Z>> plan(int k) override {
        std::vector<Piece<Z>> out;
        if (static_cast<std::size_t>(k) >= steps_.size()) return out;
        for (std::size_t s = 0; s < steps_[k].size(); ++s) {
            const Step& step = steps_[k][s];
            // What the step before has won is won again where it was not kept.
            const Federation<Z> before = most_ && s > 0 ? steps_[k][s - 1].won : Federation<Z>{};
            Federation<Z> rest = step.won, taken = before;
            for (const auto& [joint, zones] : step.commands) {
                // Not what is left of `won`: that is in pieces.
                const Federation<Z> here = most_ ? disjoint(minus(intersection(zones, step.open), taken))
                                                 : disjoint(intersection(rest, zones));
                for (const Z& z : here) out.push_back({z, joint, step.rank});
                if (most_) append(taken, zones);
                else rest = reduced(minus(rest, zones));
            }
            if (most_) rest = reduced(minus(rest, reduced(taken)));
            for (const Z& z : disjoint(rest)) out.push_back({z, -1, step.rank});
        }
        return out;
    }

  private:
    using Fixpoint<Z>::nodes_, Fixpoint<Z>::game_;
    using typename Fixpoint<Z>::Usable;

    std::int64_t due(int k) const override { return soonest_ ? 0 : Fixpoint<Z>::due(k); }

    // Dijkstra's order, by some time to the goal in hundredths of the unit. The moves of each agent add up, while agents
    // move at the same time: the longest counts, and a part of the others. With a reaction delay that part is all, since
    // else commands are more often overtaken by such as lead less far. A move that takes no time counts as one.
    std::int64_t due_before(int k, int target, std::int64_t when) override {
        if (!soonest_) return due(k);
        std::int64_t best = std::numeric_limits<std::int64_t>::max();
        std::vector<std::int64_t> busy;
        for (const Transition& transition : nodes_[k].transitions) {
            if (transition.target != target) continue;
            const Joint& joint = this->joints_[transition.joint];
            std::int64_t takes = 0;
            for (const Bound& b : joint.guard)
                if (b.i == 0) takes = std::max<std::int64_t>(takes, -(b.raw >> 1));
            std::vector<std::int64_t> times = nodes_[target].busy;  // of the agents, and the number of other moves
            times.resize(game_.automata.size() + 1, 0);
            (takes > 0 ? times[joint.owner] : times.back()) += takes > 0 ? takes : 1;
            const std::int64_t longest = *std::max_element(times.begin(), times.end() - 1);
            const std::int64_t all = std::accumulate(times.begin(), times.end() - 1, std::int64_t{0});
            const std::int64_t due = 100 * longest + (game_.delta > 0 ? 100 : 25) * (all - longest) + times.back();
            if (std::max(when, due) >= best) continue;
            best = std::max(when, due);
            busy = std::move(times);
        }
        if (!nodes_[k].scheduled || best < nodes_[k].when) nodes_[k].busy = std::move(busy);
        return best;
    }

    static constexpr double per_state = 24;  // the work of a budget that exploring a state stands for
    static constexpr double cheap = 16;      // the work of an evaluation

    // What was won at a time of what was open (in a coarse search), and where which command is right.
    struct Step {
        int rank;
        Federation<Z> open, won;
        Usable commands;
    };

    // Whether there was something to open.
    bool open_states() {
        const std::size_t count = nodes_.size();
        for (std::size_t k = 0; k < count; ++k) {
            this->check_limits();
            if (nodes_[k].reached && !nodes_[k].rest.empty()) this->expand(static_cast<int>(k), true);
        }
        return !this->queue_.empty();
    }

    // All of it is won.
    bool decided(const Federation<Z>& rest, const Z& start) const override {
        return intersection(rest, Federation<Z>{start}).empty();
    }

    const Federation<Z>& winning(Node<Z>& n) const override { return this->gathered(n); }
    const Federation<Z>& losing(Node<Z>& n) const override { return n.rest; }

    bool evaluate(int k) override {
        Node<Z>& n = nodes_[k];
        if (n.lost) return false;
        if (n.won) return this->decide_all(n);
        const auto won = [&](const Transition& transition) {
            const Node<Z>& target = nodes_[transition.target];
            return !target.done.empty() || !target.fresh.empty();
        };
        if (n.rest.empty() || std::none_of(n.transitions.begin(), n.transitions.end(), won)) return false;
        const auto before = effort.zones;
        const Federation<Z> unsafe = this->upre(n);
        const auto usable = this->cpre(n, unsafe);
        // X need not be added: whoever can wait for X can wait for what made X winning.
        Federation<Z> good = minus(forced(n), unsafe);
        for (const auto& [joint, zones] : usable) append(good, zones);
        Federation<Z> fresh = reduced(intersection(predt(good, unsafe), n.rest));
        const Federation<Z> open = most_ ? n.rest : Federation<Z>{};
        const bool grown = !fresh.empty() && take(n, fresh);
        if (grown) record(k, open, std::move(fresh), usable, unsafe);
        this->work_ += static_cast<double>(effort.zones - before);
        return grown;
    }

    // Takes fresh points of the rest off it; false: they are so few that the rest, in as many zones as it may have, stays.
    bool take(Node<Z>& n, const Federation<Z>& fresh) {
        Federation<Z> rest, cut;
        std::vector<Federation<Z>> parts;  // in a coarse search
        for (const Z& r : n.rest) {
            const bool met = touches(fresh, r);
            Federation<Z> part = met ? minus(Federation<Z>{r}, fresh) : Federation<Z>{r};
            append(met ? cut : rest, part);
            if (most_) parts.push_back(std::move(part));
        }
        for (const Z& z : cut) absorb(rest, z);
        n.coarse = most_ && rest.size() > most_;
        if (n.coarse) {
            rest.clear();
            bool grown = false;
            for (std::size_t r = 0; r < parts.size(); ++r) {
                if (parts[r].empty()) continue;
                rest.push_back(boxed(n.rest[r], parts[r]));
                grown = grown || !includes(rest.back(), n.rest[r]);
            }
            if (!grown && rest.size() == n.rest.size()) return false;
        }
        n.rest = std::move(rest);
        if (most_) {
            n.done = {n.hull};
            for (const Z& r : n.rest) n.done = reduced(intersection(n.done, around(n.hull, r)));
        } else {
            append(n.fresh, fresh);
        }
        return true;
    }

    // F before uPre is taken off: where an automaton of the environment is at its bound, and has to move.
    const Federation<Z>& forced(Node<Z>& n) const {
        return this->at_bounds(n, [&](int a) { return intersection(this->own_moves(n, a), this->at_bound(n, a)); });
    }

    void record(int k, const Federation<Z>& open, Federation<Z> fresh, const Usable& usable, const Federation<Z>& unsafe) {
        Step step{rank_++, open, std::move(fresh), {}};
        for (const auto& [joint, zones] : usable) {
            Federation<Z> now;
            for (const Z& z : minus(zones, unsafe))
                if (touches(step.won, z)) now.push_back(z);
            if (!now.empty()) step.commands.emplace_back(joint, reduced(std::move(now)));
        }
        steps_.resize(nodes_.size());
        steps_[k].push_back(std::move(step));
    }

    std::size_t most_;
    const bool soonest_;
    double spent_ = 0;      // of the budget, since `resume`
    double evaluated_ = 0;  // the work of all evaluations
    int rank_ = 1;
    std::vector<std::vector<Step>> steps_;
};

// First the game as it is, for `small_budget`, which is enough for many, and (unless that is 0) for as long as it only
// explores or takes few zones for an evaluation: a search with fewer zones would do the same again. Then three searches
// take turns, each with twice the work of its turn before. One keeps few zones per state, more of them where it ends
// without a win; what it wins is won. One, from the second turn on, has all moves from the start: with few of them what is
// won can grow by a little in each round of a play, over and over, before the others are tried.
// `soonest`: the one search with all moves, see Reach.
template <class Z>
std::pair<bool, std::unique_ptr<Reach<Z>>> solve_reach(const Game& game, LimitMonitor& monitor, double small_budget,
                                                       bool soonest) {
    using Verdict = typename Reach<Z>::Verdict;
    constexpr std::size_t largest = 8;
    if (soonest) {
        auto all = std::make_unique<Reach<Z>>(game, monitor, 0, true);
        constexpr double unlimited = 1e15;  // but for the limits
        const Verdict verdict = all->resume(unlimited);
        return {verdict == Verdict::won, std::move(all)};
    }
    auto exact = std::make_unique<Reach<Z>>(game, monitor, 0);
    const Verdict first = exact->resume(small_budget);
    if (first != Verdict::open) return {first == Verdict::won, std::move(exact)};
    std::size_t most = 1;
    std::unique_ptr<Reach<Z>> coarse, all;
    bool alone = true, too_large = false;
    for (double budget = std::max(small_budget, 1.0);; budget *= 2) {
        if (!alone && !all && !too_large) all = std::make_unique<Reach<Z>>(game, monitor, 0, true);
        if (alone && (small_budget <= 0 || !exact->is_cheap())) {
            alone = false;
            coarse = std::make_unique<Reach<Z>>(game, monitor, most);
        }
        for (double left = budget; coarse && left > 0; left -= std::max(coarse->work(), 1.0)) {
            const Verdict verdict = coarse->resume(left);
            if (verdict == Verdict::won) return {true, std::move(coarse)};
            if (verdict == Verdict::open) break;
            if (most < largest) coarse->refine(most *= 2);
            else coarse.reset();
            if (!coarse) break;
        }
        const Verdict verdict = exact->resume(budget);
        if (verdict != Verdict::open) return {verdict == Verdict::won, std::move(exact)};
        try {
            const Verdict with_all = all ? all->resume(budget) : Verdict::open;
            if (with_all != Verdict::open) return {with_all == Verdict::won, std::move(all)};
        } catch (const Limit& limit) {
            if (std::string(limit.what()) != "states") throw;
            too_large = true;  // few moves may do with fewer states
            all.reset();
        }
    }
}

}  // namespace pursue
