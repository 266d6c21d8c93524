// A strategy in fewer zones and bounds (the twin of tests/oracle/simplify.py; proof/simplify.py says why the plays stay the
// same).
#pragma once

#include <array>
#include <limits>

#include "proof/native/arena.hpp"
#include "zones/native/minimal.hpp"

namespace pursue::proof {

// One discrete state's part of a strategy while it gets smaller. Action 0 is to wait, action k + 1 is command k.
template <class Z>
class BlockZones {
  public:
    using R = typename Z::raw_t;

    // No rank is known.
    static constexpr std::int64_t unknown = std::numeric_limits<std::int64_t>::min();

    // A zone of an action within the invariant, and the bounds that make it there.
    struct Part {
        Z zone;
        std::vector<Bound> bounds;
    };

    // `late`: how late a command may come, scaled. Requires: the invariant holds somewhere.
    BlockZones(const Z& invariant, int late, std::size_t actions, int dim, Watch& watch)
        : parts(actions), invariant_(invariant), late_(late), dim_(dim), watch_(watch), origins_(actions) {}

    std::vector<std::vector<Part>> parts;  // of each action

    void add(std::size_t action, const Z& zone, std::int64_t rank) {
        parts[action].push_back({zone, {}});
        origins_[action].push_back({zone, rank});
    }

    void simplify() {
        for (std::size_t k = 1; k <= parts.size(); ++k) merge(k % parts.size());
        for (std::size_t k = 1; k <= parts.size(); ++k) {
            relax_all(k % parts.size());
            drop(k % parts.size());
        }
    }

  private:
    // A zone that the action had, and its rank.
    struct Origin {
        Z zone;
        std::int64_t rank;
    };

    // Whether a command that is due in the one may as well be given in the other.
    static bool leads_to(const Origin& one, const Origin& other) {
        return &one == &other || (one.rank != unknown && other.rank != unknown && other.rank <= one.rank);
    }

    // Whether the action may have this zone, too: no play notices.
    bool may_have(std::size_t action, const Z& zone) {
        watch_.tick();
        for (std::size_t other = 0; other < parts.size(); ++other)
            if (other != action)
                for (const Part& part : parts[other])
                    if (meets(zone, part.zone)) return false;
        if (action == 0) return true;
        for (const Origin& origin : origins_[action]) {
            Z met = zone;
            if (!intersect(met, origin.zone)) continue;
            Zones<Z> known;
            for (const Origin& other : origins_[action])
                if (leads_to(origin, other)) known.push_back(other.zone);
            if (!adds_nothing(zone, later(met, dim_), known)) return false;
        }
        if (!late_) return true;
        Zones<Z> known;
        for (const Origin& other : origins_[action]) known.push_back(other.zone);
        for (std::size_t in_flight = 1; in_flight < parts.size(); ++in_flight)
            if (in_flight != action)
                for (const Origin& origin : origins_[in_flight])
                    if (!adds_nothing(zone, later_within(origin.zone, late_, dim_), known)) return false;
        return true;
    }

    // Whether all points of the zone that are met later are known ones.
    bool adds_nothing(const Z& zone, Z met, const Zones<Z>& known) {
        return !intersect(met, zone) || !intersect(met, invariant_) || outside(met, known, watch_).empty();
    }

    // Fewer zones for the action, where a hull of some will do.
    void merge(std::size_t action) {
        std::vector<Part>& some = parts[action];
        if (some.size() > 2) {
            Z all = some[0].zone;
            for (const Part& part : some) all = hull(all, part.zone);
            if (may_have(action, all)) some.assign(1, {all, {}});
        }
        for (std::size_t k = 0; k < some.size(); ++k)
            for (std::size_t n = k + 1; n < some.size();) {
                const Z together = hull(some[k].zone, some[n].zone);
                if (!may_have(action, together)) {
                    ++n;
                    continue;
                }
                some[k] = {together, {}};
                some.erase(some.begin() + static_cast<std::ptrdiff_t>(n));
                n = k + 1;
            }
    }

    // Fewer bounds for each zone of the action; differences go first, then upper bounds, then lower ones.
    void relax_all(std::size_t action) {
        for (Part& part : parts[action]) {
            std::vector<Bound> kept;
            for (const auto& [i, j, bound] : minimal(part.zone, dim_)) kept.push_back({i, j, bound});
            Z zone = part.zone;
            std::vector<Bound> by_worth = kept;
            const auto worth = [](const Bound& b) { return std::array<int, 3>{b.i && b.j ? 0 : b.i ? 1 : 2, b.i, b.j}; };
            std::sort(by_worth.begin(), by_worth.end(), [&](const Bound& a, const Bound& b) { return worth(a) < worth(b); });
            for (const Bound& bound : by_worth) {
                std::vector<Bound> fewer;
                for (const Bound& other : kept)
                    if (other.i != bound.i || other.j != bound.j) fewer.push_back(other);
                Z larger = invariant_;
                if (!take(larger, fewer) || !(equal(larger, zone) || may_have(action, larger))) continue;
                kept = fewer;
                zone = larger;
            }
            part = {zone, kept};
        }
    }

    static bool take(Z& zone, const std::vector<Bound>& bounds) {
        return std::all_of(bounds.begin(), bounds.end(),
                           [&](const Bound& b) { return constrain(zone, b.i, b.j, static_cast<R>(b.raw)); });
    }

    // No zone of the action that the others cover.
    void drop(std::size_t action) {
        std::vector<Part>& some = parts[action];
        for (std::size_t k = some.size(); k-- > 0;) {
            Zones<Z> rest;
            for (std::size_t n = 0; n < some.size(); ++n)
                if (n != k) rest.push_back(some[n].zone);
            // A command is decided before time leaves the zone in which it was met: only a zone in one other is idle.
            const bool idle = action == 0 ? outside(some[k].zone, rest, watch_).empty() : one_includes(rest, some[k].zone);
            if (idle) some.erase(some.begin() + static_cast<std::ptrdiff_t>(k));
        }
    }

    const Z invariant_;
    const int late_, dim_;
    Watch& watch_;
    std::vector<std::vector<Origin>> origins_;  // of each action
};

}  // namespace pursue::proof
