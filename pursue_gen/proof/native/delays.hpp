// What one discrete state's part of a strategy means while time passes: where it waits, where it acts, where it breaks
// (the twin of tests/oracle/delays.py, step by step: what comes first there comes first here).
#pragma once

#include "proof/native/arena.hpp"

namespace pursue::proof {

// Why a strategy fails; the texts are in reasons.py, in this order.
enum class Fault {
    bad,
    no_block,
    no_progress,
    not_covered,
    time_is_blocked,
    ends_in_no_point,
    waits_for_ever,
    not_enabled,
    too_late,
    contradiction,
    not_controllable,
    no_joint_move,
    for_ever,
    limit,
};

// The strategy fails here: why, and the points at which it does.
template <class Z>
struct Broken {
    Fault fault;
    Z zone;
    const JointMove<Z>* move = nullptr;  // the one that makes no progress
};

// A command in one of its zones. Without a move it is no joint move of the controller, and `fault` says why.
template <class Z>
struct Act {
    Z zone;
    int key;  // the number of the zone
    const JointMove<Z>* move;
    Fault fault;
};

// What the strategy says in one discrete state, every zone within the invariant.
template <class Z>
struct Advice {
    std::vector<std::pair<Z, int>> wait;  // zones, and their numbers
    std::vector<Act<Z>> acts;
    std::vector<std::vector<int>> near;  // for each act the others that are met while it may be decided or on its way
    std::vector<Zones<Z>> disputed;      // for each act the points at which the strategy says to wait as well
    Zones<Z> waits;                      // all points to wait at, in few zones

    // Completes `near`, `disputed` and `waits`, for commands that may be late by `reaction`.
    void complete(int reaction, int dim, Watch& watch) {
        for (std::size_t k = 0; k < acts.size(); ++k) {
            watch.tick();
            const Z flight = reaction ? later_within(acts[k].zone, reaction, dim) : acts[k].zone;
            std::vector<int> met;
            for (std::size_t other = 0; other < acts.size(); ++other)
                if (other != k && meets(flight, acts[other].zone)) met.push_back(static_cast<int>(other));
            near.push_back(std::move(met));
            Zones<Z> both;
            for (const auto& [zone, key] : wait) {
                both.push_back(acts[k].zone);
                if (!intersect(both.back(), zone)) both.pop_back();
            }
            disputed.push_back(std::move(both));
        }
        Zones<Z> zones;
        for (const auto& [zone, key] : wait) zones.push_back(zone);
        waits = merged(zones, watch);
    }

    // All points for which there is advice, in few zones.
    Zones<Z> covered(Watch& watch) const {
        Zones<Z> zones;
        for (const Act<Z>& act : acts) zones.push_back(act.zone);
        Zones<Z> result = waits;
        append(result, merged(zones, watch));
        return result;
    }
};

// What may happen from an entry.
template <class Z>
struct Passage {
    Zones<Z> waited;                                       // the points that are waited in
    std::vector<std::pair<const JointMove<Z>*, Z>> taken;  // where which command may take effect
    std::vector<int> used;                                 // numbers of zones

    // All points at which the game may be.
    Zones<Z> active(Watch& watch) const {
        Zones<Z> zones = waited;
        for (const auto& [move, flight] : taken) zones.push_back(flight);
        return merged(zones, watch);
    }
};

// Follows the strategy from entries of one discrete state until a discrete step.
template <class Z>
class Delay {
  public:
    using R = typename Z::raw_t;

    Delay(const Situation<Z>& situation, const Advice<Z>& advice, const Rules& rules, int dim, Watch& watch)
        : situation_(situation), advice_(advice), rules_(rules), dim_(dim), watch_(watch), decided_(advice.acts.size()) {}

    // `pieces`: the entries, or those of their points that are in no command's zone and perhaps others of theirs.
    // Requires: the invariant holds at all points of the entries. Throws Broken where the strategy fails.
    Passage<Z> pass(const Zones<Z>& entries, Zones<Z> pieces) {
        for (std::size_t k = 0; k < advice_.acts.size(); ++k) {
            const Z& zone = advice_.acts[k].zone;
            watch_.tick();
            for (const Z& entry : entries) {
                Z common = entry;
                if (intersect(common, zone)) decide(k, rules_.prompt ? common : future_in(common, zone));
            }
            if (!decided_[k].empty()) pieces = without(pieces, zone, watch_);
        }
        // What time passes first is first.
        std::stable_sort(pieces.begin(), pieces.end(), [&](const Z& a, const Z& b) { return starts(a) > starts(b); });
        Passage<Z> out;
        for (const Z& piece : pieces)
            // What is met on the way from another piece was followed with that.
            if (!one_includes(out.waited, piece)) append(out.waited, wait(piece));
        for (const auto& [zone, key] : advice_.wait) {
            const Z& to_wait = zone;
            watch_.tick();
            if (std::any_of(out.waited.begin(), out.waited.end(), [&](const Z& part) { return meets(part, to_wait); }))
                out.used.push_back(key);
        }
        for (std::size_t k = 0; k < decided_.size(); ++k)
            if (!decided_[k].empty()) take_effect(k, out);
        return out;
    }

  private:
    [[noreturn]] static void fail(Fault fault, const Z& zone) { throw Broken<Z>{fault, zone}; }

    Z future_in(const Z& zone, const Z& within) const {
        Z future = later(zone, dim_);
        intersect(future, within);
        return future;
    }

    // The sum of the lower bounds: larger for what time passes first.
    std::int64_t starts(const Z& zone) const {
        std::int64_t sum = 0;
        for (int i = 0; i < dim_; ++i) sum += zone.at(0, i);
        return sum;
    }

    void decide(std::size_t k, const Z& zone) {
        if (!one_includes(decided_[k], zone)) decided_[k].push_back(zone);
    }

    // Lets time pass from points outside all commands' zones: the points that are waited in.
    Zones<Z> wait(const Z& piece) {
        const Z future = future_in(piece, situation_.invariant);
        std::vector<std::size_t> acts;
        Zones<Z> met;
        for (std::size_t k = 0; k < advice_.acts.size(); ++k) {
            met.push_back(future);
            if (intersect(met.back(), advice_.acts[k].zone))
                acts.push_back(k);
            else
                met.pop_back();
        }
        // The piece shares no point with a command's zone, so time meets no such point before one that is waited in.
        Zones<Z> waited{future}, from;
        for (const Z& common : met) from.push_back(later(common, dim_));
        for (const Z& after : from) waited = without(waited, after, watch_);
        for (const Z& zone : waited) {
            const Zones<Z> uncovered = outside(zone, advice_.waits, watch_);
            if (!uncovered.empty()) fail(Fault::not_covered, uncovered[0]);
        }
        for (std::size_t n = 0; n < met.size(); ++n) {
            if (one_includes(decided_[acts[n]], met[n])) continue;
            Zones<Z> first{met[n]};
            for (std::size_t other = 0; other < met.size(); ++other) {
                if (other == n) continue;
                for (const Z& before : difference(met[other], from[n])) first = without(first, later(before, dim_), watch_);
            }
            for (const Z& zone : first) {
                if (!rules_.prompt) decide(acts[n], zone);
                else
                    for (const Z& part : promptly(zone)) decide(acts[n], part);
            }
        }
        check_end(piece, waited, met);
        return waited;
    }

    // Of a command's zone, which time enters from outside: the first instants, where there are such; where the zone is
    // open, the way up to the next constant or the environment's next move, or as long as rules.instant.
    Zones<Z> promptly(const Z& zone) {
        Zones<Z> result;
        for (const Z& start : entrances(zone)) {
            Z at_once = start;
            const bool closed = intersect(at_once, zone);
            if (closed) result.push_back(at_once);
            for (const Z& late : closed ? difference(start, at_once) : Zones<Z>{start}) {
                Z soon = rules_.instant ? later_within(late, rules_.instant, dim_) : soon_after(late);
                if (!intersect(soon, zone)) continue;
                if (rules_.instant) result.push_back(soon);
                else append(result, before_news(soon));
            }
        }
        return result;
    }

    // The points through which time enters the zone: in it, or just before it where its lower bounds are strict.
    Zones<Z> entrances(const Z& zone) {
        Z closed = earlier(zone);
        for (int i = 1; i < dim_; ++i)
            if (!constrain(closed, 0, i, static_cast<R>(zone.at(0, i) | 1))) return {};
        Zones<Z> result;
        for (int i = 1; i < dim_; ++i) {
            result.push_back(closed);
            if (!constrain(result.back(), i, 0, static_cast<R>(2 * -(zone.at(0, i) >> 1) + 1))) result.pop_back();
        }
        return merged(result, watch_);
    }

    // What time reaches from the zone before any clock gets to a new constant (a hull of it).
    Z soon_after(Z zone) const {
        for (int i = 1; i < dim_; ++i) {
            zone.at(0, i) = static_cast<R>(zone.at(0, i) & ~1);
            if (zone.at(i, 0) < INF<R>) zone.at(i, 0) = static_cast<R>((zone.at(i, 0) + 1) & ~1);
        }
        free_padding(zone, dim_);
        [[maybe_unused]] const bool some = close(zone);
        assert(some);
        return zone;
    }

    // The points of the zone before a new move becomes possible to the environment.
    Zones<Z> before_news(const Z& zone) {
        Zones<Z> result{zone}, known;
        for (const JointMove<Z>& move : situation_.moves) {
            if (move.controllable || !move.possible) continue;
            if (std::any_of(known.begin(), known.end(), [&](const Z& z) { return equal(z, move.enabled); })) continue;
            known.push_back(move.enabled);
            Z common = zone;
            if (!intersect(common, move.enabled)) continue;
            for (const Z& before : difference(zone, later(common, dim_))) {
                Z after = later(before, dim_);
                if (intersect(after, common)) result = without(result, later(after, dim_), watch_);
            }
        }
        return result;
    }

    // Whoever is at the bound of an invariant must be able to move by itself: no command comes at the points that are
    // waited in. From the piece time leads there, and to those of commands that are met.
    void check_end(const Z& piece, const Zones<Z>& waited, const Zones<Z>& met) {
        if (!situation_.bounds.empty() && !situation_.strict) {
            for (const Z& part : waited) check_obliged(part, Fault::time_is_blocked);
        } else if (situation_.strict || rules_.must_end) {
            Zones<Z> never{piece};
            for (const Z& common : met) never = without(never, earlier(common), watch_);
            if (!never.empty()) fail(situation_.strict ? Fault::ends_in_no_point : Fault::waits_for_ever, never[0]);
        }
    }

    // At each of the points that is at the bound of an invariant someone must be able to move by itself.
    void check_obliged(const Z& points, Fault fault) {
        std::vector<std::pair<int, Z>> ends;
        for (const auto& bound : situation_.bounds) {
            Z last = points;
            if (constrain(last, 0, bound.clock, static_cast<R>(2 * -(bound.raw >> 1) + 1))) ends.emplace_back(bound.owner, last);
        }
        for (const auto& end : ends) {
            Zones<Z> rest{end.second};
            for (const JointMove<Z>& move : situation_.moves) {
                if (move.controllable || !move.possible) continue;
                // In a reach game one that must move is enough: it will, whoever else is at a bound as well.
                for (const auto& obliged : ends) {
                    if (obliged.first != move.owner || (!rules_.must_end && &obliged != &end)) continue;
                    Z common = obliged.second;
                    if (intersect(common, move.enabled)) rest = without(rest, common, watch_);
                }
            }
            if (!rest.empty()) fail(fault, rest[0]);
        }
    }

    // Adds where command k takes effect, and those that it meets on its way.
    void take_effect(std::size_t k, Passage<Z>& out) {
        const Act<Z>& act = advice_.acts[k];
        out.used.push_back(act.key);
        Zones<Z> flights;
        for (const Z& zone : decided_[k]) flights.push_back(flight(zone));
        check_decided(k);
        for (const Z& points : flights) effect(act, points, out);
        for (const Z& points : flights)
            for (int other : advice_.near[k]) {
                watch_.tick();
                const Act<Z>& overtaking = advice_.acts[other];
                if (overtaking.move == act.move) continue;
                Z common = points;
                if (!intersect(common, overtaking.zone)) continue;
                // The one that was decided first ends the time that passes here, so its flight bounds theirs.
                if (rules_.reaction) common = later_within(common, rules_.reaction, dim_);
                intersect(common, points);
                out.used.push_back(overtaking.key);
                effect(overtaking, common, out);
            }
    }

    // The points at which a command may take effect that is decided in the zone. Time does not take it beyond the end of
    // an invariant: who is at its bound there moves, and the command is stale.
    Z flight(const Z& zone) {
        if (!rules_.reaction) return zone;
        Z reached = later_within(zone, rules_.reaction, dim_);
        if (includes(situation_.invariant, reached) || situation_.strict) return reached;
        intersect(reached, situation_.invariant);
        check_obliged(reached, Fault::too_late);
        return reached;
    }

    // The command must be a clear one where it is decided, and enabled.
    void check_decided(std::size_t k) const {
        const JointMove<Z>* move = advice_.acts[k].move;
        for (const Z& zone : decided_[k]) {
            for (const Z& waited : advice_.disputed[k]) {
                Z both = waited;
                if (intersect(both, zone)) fail(Fault::contradiction, both);
            }
            if (move && move->possible && !includes(move->enabled, zone))
                fail(Fault::not_enabled, difference(zone, move->enabled)[0]);
        }
    }

    static void effect(const Act<Z>& act, const Z& points, Passage<Z>& out) {
        if (!act.move) fail(act.fault, points);
        if (!act.move->possible) fail(Fault::not_enabled, points);
        if (!includes(act.move->enabled, points)) fail(Fault::too_late, difference(points, act.move->enabled)[0]);
        out.taken.emplace_back(act.move, points);
    }

    const Situation<Z>& situation_;
    const Advice<Z>& advice_;
    const Rules& rules_;
    const int dim_;
    Watch& watch_;
    std::vector<Zones<Z>> decided_;  // for each act the points at which it is decided
};

}  // namespace pursue::proof
