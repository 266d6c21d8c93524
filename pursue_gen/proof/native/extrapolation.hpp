// The largest constants that the rest of a play compares each clock with (the twin of tests/oracle/extrapolation.py).
//
// Per discrete state the largest constant that a clock is compared with before its next reset (Behrmann, Bouyer, Fleury and
// Larsen, TACAS 2003, with the strategy's zones as further guards). Extrapolation only adds points, so it hides no failure.
#pragma once

#include <stdexcept>
#include <vector>

#include "proof/native/closed_loop.hpp"

namespace pursue::proof {

// The largest constants of every discrete state that moves of the loop lead to from the initial one; -1: none.
template <class Z>
class MaxConstants {
  public:
    using R = typename Z::raw_t;

    MaxConstants(ClosedLoop<Z>& loop, int start) : loop_(loop) {
        explore(start);
        spread();
    }

    // Whether moves lead to the state.
    bool knows(int state) const {
        return state < static_cast<int>(largest_.size()) && !largest_[state].empty();
    }

    // The zone and all points that the rest of the play cannot tell from it, within the state's invariant.
    Z extrapolate(const Z& zone, int state) const {
        const std::vector<std::int64_t>& largest = largest_.at(state);
        if (largest.empty()) throw std::logic_error("no move leads to this state");
        const int dim = loop_.arena.dim;
        Z larger = zone;
        for (int x = 1; x < dim; ++x)
            if (largest[x] < 0) free_clock(larger, x);
        bool changed = false;
        for (int i = 0; i < dim; ++i)
            for (int j = 0; j < dim; ++j) {
                if (i == j) continue;
                R& bound = larger.at(i, j);
                const std::int64_t high = 2 * std::max<std::int64_t>(0, largest[i]) + 1;
                const std::int64_t low = -2 * std::max<std::int64_t>(0, largest[j]);
                if (bound < INF<R> && bound > high) {
                    bound = INF<R>;
                    changed = true;
                } else if (bound < low) {
                    bound = static_cast<R>(low);
                    changed = true;
                }
            }
        if (changed) {
            free_padding(larger, dim);
            close(larger);
        }
        const Situation<Z>& situation = loop_.arena.situation(state);
        return situation.possible && intersect(larger, situation.invariant) ? larger : zone;
    }

  private:
    void explore(int start) {
        std::deque<int> pending;
        const auto meet = [&](int state) {
            if (state >= static_cast<int>(largest_.size())) {
                largest_.resize(state + 1);
                before_.resize(state + 1);
            }
            if (!largest_[state].empty()) return;
            largest_[state] = none();
            pending.push_back(state);
        };
        for (meet(start); !pending.empty();) {
            loop_.watch.tick();
            const int state = pending.front();
            pending.pop_front();
            std::vector<std::int64_t> here = largest_[state];
            const auto note = [&](int x, std::int64_t constant) {
                here[x] = std::max(here[x], constant + loop_.rules.reaction);
            };
            for (const auto& bound : loop_.arena.situation(state).bounds) note(bound.clock, bound.raw >> 1);
            loop_.describe(
                state,
                [&](const JointMove<Z>& move) {
                    for (const Bound& bound : loop_.arena.network().edges[move.edges[0]].guard)
                        note(bound.i ? bound.i : bound.j, std::abs(static_cast<std::int64_t>(loop_.arena.scaled(bound.raw)) >> 1));
                    meet(move.target);
                    std::pair<int, std::vector<int>> step{state, move.resets};
                    auto& steps = before_[move.target];
                    if (steps.empty() || steps.back() != step) steps.push_back(std::move(step));
                },
                note);
            largest_[state] = here;
        }
    }

    // What a clock is compared with in a state counts before it, but for clocks that the step into it resets. As a rule
    // later states have higher numbers: these come first.
    void spread() {
        std::vector<int> pending;
        std::vector<bool> queued(largest_.size(), false);
        for (std::size_t state = 0; state < largest_.size(); ++state) {
            if (largest_[state].empty()) continue;
            pending.push_back(static_cast<int>(state));
            queued[state] = true;
        }
        while (!pending.empty()) {
            loop_.watch.tick();
            const int state = pending.back();
            pending.pop_back();
            queued[state] = false;
            const std::vector<std::int64_t>& here = largest_[state];
            for (const auto& [earlier, resets] : before_[state]) {
                if (earlier == state) continue;
                std::vector<std::int64_t>& there = largest_[earlier];
                bool changed = false;
                for (int x = 1; x < loop_.arena.dim; ++x)
                    if (here[x] > there[x] && std::find(resets.begin(), resets.end(), x) == resets.end()) {
                        there[x] = here[x];
                        changed = true;
                    }
                if (changed && !queued[earlier]) {
                    queued[earlier] = true;
                    pending.push_back(earlier);
                }
            }
        }
    }

    std::vector<std::int64_t> none() const { return std::vector<std::int64_t>(loop_.arena.dim, -1); }

    ClosedLoop<Z>& loop_;
    std::vector<std::vector<std::int64_t>> largest_;  // by state; empty: no move leads there
    std::vector<std::vector<std::pair<int, std::vector<int>>>> before_;  // by state, the steps to it: from where, resets
};

}  // namespace pursue::proof
