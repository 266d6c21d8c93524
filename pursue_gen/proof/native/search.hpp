// The checker's searches through the closed loop (the twins of those in tests/oracle/search.py and invariant.py).
#pragma once

#include <optional>

#include "proof/native/extrapolation.hpp"

namespace pursue::proof {

// How a search ended: the failure, if there is one, with the play that leads to it.
template <class Z>
struct Outcome {
    std::size_t states = 0;  // symbolic states that were met
    std::optional<Broken<Z>> failure;
    std::vector<const JointMove<Z>*> steps;
    int state = 0;  // where it fails
};

// The zones of each discrete state that were met: numbers of entries.
using Passed = std::unordered_map<int, std::vector<int>>;

template <class Z>
class Search {
  public:
    // With `exact` zones are not extrapolated; at most `limit` symbolic states are met. `constants` are those of the loop,
    // if an earlier search needed them.
    Search(ClosedLoop<Z>& loop, std::optional<MaxConstants<Z>>& constants, const Entry<Z>& start, bool exact,
           std::size_t limit)
        : loop_(loop), constants_(constants), start_(start), exact_(exact), limit_(limit) {
        loop_.used.clear();
        loop_.arena.check_width(start.zone);
        if (constants_ && !constants_->knows(start.state)) constants_.reset();
    }

    // Everything that is reachable, breadth first; `many` zones of a discrete state (0: never) become one.
    Outcome<Z> all(std::size_t many) {
        Outcome<Z> out;
        std::deque<Found> found{{start_, -1, nullptr, true}};
        Passed passed{{start_.state, {0}}};
        bool hulled = false;
        const auto failed = [&](Broken<Z> broken, int n, const JointMove<Z>* last, int state) {
            out.failure = broken;
            out.state = state;
            if (last) out.steps.push_back(last);
            for (; found[n].before >= 0; n = found[n].before) out.steps.push_back(found[n].move);
            std::reverse(out.steps.begin(), out.steps.end());
            out.states = found.size();
            return out;
        };
        for (std::size_t next = 0; next < found.size(); ++next) {
            loop_.watch.reached(found.size(), found.size() - next);
            if (!found[next].current) continue;
            const Entry<Z> entry = found[next].entry;
            const int n = static_cast<int>(next);
            Steps<Z> successors;
            try {
                successors = loop_.successors(entry);
            } catch (const Broken<Z>& broken) {
                if (!hulled) return failed(broken, n, nullptr, entry.state);
                loop_.used.clear();
                return all(0);
            }
            for (const auto& [move, step] : successors) {
                const int target = step.state;
                Z after = exact_ ? step.zone : constants().extrapolate(step.zone, target);
                std::vector<int>& known = passed[target];
                if (std::any_of(known.begin(), known.end(), [&](int k) { return includes(found[k].entry.zone, after); })) continue;
                if (found.size() >= limit_) return failed({Fault::limit, after}, n, move, target);
                if (!exact_ && many && known.size() >= many) {
                    for (int k : known) after = hull(after, found[k].entry.zone);
                    hulled = true;
                } else if (!exact_) {
                    join_neighbours(after, known, found);
                }
                add({target, after}, n, move, known, found);
            }
        }
        out.states = found.size();
        return out;
    }

    // Depth first: an entry is proven when all that may follow it are, so every play ends in the goal.
    Outcome<Z> ends() {
        Outcome<Z> out;
        std::unordered_map<int, Zones<Z>> proven, open;
        std::deque<OnPath> path;
        std::optional<std::pair<const JointMove<Z>*, Entry<Z>>> coming{{nullptr, start_}};
        const auto failed = [&](Broken<Z> broken, const JointMove<Z>* move, int state) {
            for (const OnPath& step : path)
                if (step.move) out.steps.push_back(step.move);
            if (move) out.steps.push_back(move);
            out.failure = broken;
            out.state = state;
            return out;
        };
        while (coming || !path.empty()) {
            loop_.watch.reached(out.states, path.size());
            if (!coming) {
                OnPath& step = path.back();
                if (!step.left.empty()) {
                    coming = std::move(step.left.back());
                    step.left.pop_back();
                } else {
                    open[step.entry.state].pop_back();
                    Zones<Z>& known = proven[step.entry.state];
                    known.erase(std::remove_if(known.begin(), known.end(),
                                               [&](const Z& zone) { return includes(step.entry.zone, zone); }),
                                known.end());
                    known.push_back(step.entry.zone);
                    path.pop_back();
                }
                continue;
            }
            const JointMove<Z>* move = coming->first;
            const int state = coming->second.state;
            const Z zone = exact_ ? coming->second.zone : constants().extrapolate(coming->second.zone, state);
            coming.reset();
            if (loop_.won(state) || one_includes(proven[state], zone)) continue;
            Zones<Z>& on_path = open[state];
            if (comes_back(on_path, zone, state)) return failed({Fault::for_ever, zone}, move, state);
            if (out.states >= limit_) return failed({Fault::limit, zone}, move, state);
            ++out.states;
            Steps<Z> successors;
            try {
                successors = loop_.successors({state, zone});
            } catch (const Broken<Z>& broken) {
                return failed(broken, move, state);
            }
            on_path.push_back(zone);
            path.push_back({{state, zone}, move, std::move(successors)});
        }
        return out;
    }

    // The number of zones of a safety strategy, if no play leaves the points that it covers; else none. Each discrete state
    // is looked at once, as if every covered point could be entered. The start is covered, and from all covered points the
    // loop finds no failure and no step but to covered ones: so by induction no play leaves them, and none fails.
    std::optional<std::size_t> invariant() {
        if (!outside(start_.zone, loop_.covered(start_.state), loop_.watch).empty()) return std::nullopt;
        std::deque<int> pending{start_.state};
        std::unordered_map<int, Zones<Z>> known{{start_.state, {}}};
        while (!pending.empty()) {
            loop_.watch.reached(known.size(), pending.size());
            const int state = pending.front();
            pending.pop_front();
            Steps<Z> steps;
            try {
                steps = loop_.steps_from_all(state);
            } catch (const Broken<Z>&) {
                return std::nullopt;
            }
            for (const auto& [move, step] : steps) {
                const auto [met, is_new] = known.try_emplace(step.state);
                if (is_new) pending.push_back(step.state);
                const Z& after = step.zone;
                if (std::any_of(met->second.begin(), met->second.end(), [&](const Z& z) { return equal(z, after); })) continue;
                if (!outside(after, loop_.covered(step.state), loop_.watch).empty()) return std::nullopt;
                met->second.push_back(after);
            }
        }
        std::size_t zones = 0;
        for (const auto& [state, steps] : known) zones += loop_.covered(state).size();
        return zones;
    }

    // The largest value of a clock at the goal, or if there is a place to leave, with the steps that leave it. Breadth
    // first; `many` zones of a discrete state (0: never) become one. None if nothing bounds it, or the limit was met.
    // `looked`: so many symbolic states before the goal were looked at. Throws Broken where the strategy fails.
    std::optional<std::int64_t> latest(int clock, const std::optional<Place>& left, std::size_t many, std::size_t& looked) {
        std::int64_t latest = 0;
        const auto noted = [&](const Z& zone) {
            const auto bound = zone.at(clock, 0);
            latest = std::max<std::int64_t>(latest, bound >> 1);
            return bound < INF<typename Z::raw_t>;
        };
        std::deque<Found> found{{start_, -1, nullptr, true}};
        Passed passed{{start_.state, {0}}};
        for (std::size_t next = 0; next < found.size(); ++next) {
            if (!found[next].current) continue;
            const Entry<Z> entry = found[next].entry;
            if (loop_.won(entry.state)) {
                if (!left && !noted(entry.zone)) return std::nullopt;
                continue;
            }
            loop_.watch.reached(found.size(), found.size() - next - 1);
            if (looked++ >= limit_) return std::nullopt;
            for (const auto& [move, step] : loop_.successors(entry)) {
                const bool leaves = left && loop_.is_at(entry.state, *left) && !loop_.is_at(step.state, *left);
                if (leaves && !noted(step.zone)) return std::nullopt;
                Z after = constants().extrapolate(step.zone, step.state);
                std::vector<int>& known = passed[step.state];
                if (std::any_of(known.begin(), known.end(), [&](int k) { return includes(found[k].entry.zone, after); })) continue;
                if (many && known.size() >= many) {
                    for (int k : known) after = hull(after, found[k].entry.zone);
                } else {
                    join_neighbours(after, known, found);
                }
                add({step.state, after}, -1, move, known, found);
            }
        }
        return latest;
    }

  private:
    // An entry that was met, from which one, and whether no later one includes it.
    struct Found {
        Entry<Z> entry;
        int before;
        const JointMove<Z>* move;
        bool current;
    };

    // An entry on the current play, with the entries after it that are still to be proven.
    struct OnPath {
        Entry<Z> entry;
        const JointMove<Z>* move;
        Steps<Z> left;
    };

    // A discrete state that is so often on one play of a reach game is searched for a loop that only clocks hide.
    static constexpr std::size_t often = 8;

    const MaxConstants<Z>& constants() {
        if (!constants_) constants_.emplace(loop_, start_.state);
        return *constants_;
    }

    // The zone together with those of the known ones with which it makes one zone.
    void join_neighbours(Z& zone, const std::vector<int>& known, const std::deque<Found>& found) const {
        Apart last, other;  // what kept two zones apart: often the same, as in `absorb`
        for (bool grown = true; grown;) {
            grown = false;
            for (int k : known) {
                const Z& met = found[k].entry.zone;
                if (apart(zone, met, last) || apart(zone, met, other) || includes(zone, met)) continue;
                if (const std::optional<Apart> by = what_parts(zone, met)) {
                    other = std::exchange(last, *by);
                    continue;
                }
                zone = hull(zone, met);
                grown = true;
            }
        }
    }

    // Adds an entry, in the place of those that it includes.
    static void add(const Entry<Z>& entry, int before, const JointMove<Z>* move, std::vector<int>& known, std::deque<Found>& found) {
        known.erase(std::remove_if(known.begin(), known.end(),
                                   [&](int k) {
                                       const bool included = includes(entry.zone, found[k].entry.zone);
                                       if (included) found[k].current = false;
                                       return included;
                                   }),
                    known.end());
        known.push_back(static_cast<int>(found.size()));
        found.push_back({entry, before, move, true});
    }

    // Whether a play may go round for ever: with exact zones each point of the zone has a predecessor in the earlier one
    // on the path. When the zone includes that one, there are plays of every length, and so endless ones; likewise if it
    // changes only in what no guard sees.
    bool comes_back(const Zones<Z>& on_path, const Z& zone, int state) {
        for (const Z& other : on_path)
            if (includes(zone, other)) return true;
        if (on_path.size() < often) return false;
        const Z widened = constants().extrapolate(zone, state);
        return std::any_of(on_path.begin(), on_path.end(),
                           [&](const Z& other) { return equal(widened, constants().extrapolate(other, state)); });
    }

    ClosedLoop<Z>& loop_;
    std::optional<MaxConstants<Z>>& constants_;
    const Entry<Z> start_;
    const bool exact_;
    const std::size_t limit_;
};

}  // namespace pursue::proof
