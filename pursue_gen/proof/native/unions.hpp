// Unions of zones, as vectors: what the checker does with them (the twin of tests/oracle/unions.py and of some of
// zones/dbm.py).
//
// Zones are as `dbm.hpp` has them. A zone type may have more clocks than the network: `dim` is the number of the network's
// clocks plus one, and the clocks from there on are padding. Every zone here has a *free* padding, which nothing bounds:
// so zones with the same points of the network's clocks are equal bound by bound. The functions keep it so.
#pragma once

#include "proof/native/watch.hpp"
#include "zones/native/federation.hpp"

namespace pursue::proof {

template <class Z>
using Zones = std::vector<Z>;

// Makes the clocks from `dim` on free. The matrix need not be canonical.
template <class Z>
void free_padding(Z& z, int dim) {
    for (int i = 0; i < dim; ++i)
        for (int p = dim; p < Z::size; ++p) z.at(i, p) = z.at(i, 0);
}

template <class Z>
bool has_free_padding(const Z& z, int dim) {
    for (int p = dim; p < Z::size; ++p)
        for (int i = 0; i < Z::size; ++i)
            if (i != p && (z.at(i, p) != z.at(i, 0) || z.at(p, i) < INF<typename Z::raw_t>)) return false;
    return true;
}

// The contract of the padding; too slow for any but a checked build.
template <class Z>
inline void check_padding([[maybe_unused]] const Z& z, [[maybe_unused]] int dim) {
#ifdef PURSUE_CHECKED
    assert(is_canonical(z) && has_free_padding(z, dim));
#endif
}

// What time leads to from the zone.
template <class Z>
Z later(Z z, int dim) {
    check_padding(z, dim);
    up(z);
    free_padding(z, dim);
    check_padding(z, dim);
    return z;
}

// What a time in [0, delay] leads to from the zone. Requires: delay >= 0.
template <class Z>
Z later_within(Z z, int delay, int dim) {
    check_padding(z, dim);
    up_within(z, delay);
    free_padding(z, dim);
    check_padding(z, dim);
    return z;
}

template <class Z>
Z earlier(Z z) {
    down(z);
    return z;
}

template <class Z>
bool equal(const Z& a, const Z& b) {
    return std::equal(std::begin(a.m), std::end(a.m), std::begin(b.m));
}

template <class Z>
bool meets(Z a, const Z& b) {
    return intersect(a, b);
}

// Appends the points of a that are not in b, as disjoint zones: a itself where they have no point in common.
template <class Z>
void difference(const Z& a, const Z& b, Zones<Z>& out) {
    attend(BOUNDS<Z>);
    if (clearly_disjoint(a, b)) {
        out.push_back(a);
        return;
    }
    const std::size_t before = out.size();
    Z rest = a;
    for (int i = 0; i < Z::size; ++i)
        for (int j = 0; j < Z::size; ++j) {
            if (i == j || b.at(i, j) >= rest.at(i, j)) continue;
            attend(BOUNDS<Z>);
            out.push_back(rest);
            if (!constrain(out.back(), j, i, complement(b.at(i, j)))) out.pop_back();
            if (constrain(rest, i, j, b.at(i, j))) continue;
            out.resize(before, a);
            out.push_back(a);
            return;
        }
}

template <class Z>
Zones<Z> difference(const Z& a, const Z& b) {
    Zones<Z> out;
    difference(a, b, out);
    return out;
}

// The points of the pieces that are not in the zone.
template <class Z>
Zones<Z> without(const Zones<Z>& pieces, const Z& zone, Watch& watch) {
    watch.tick();
    Zones<Z> out;
    out.reserve(pieces.size() + 2);
    for (const Z& piece : pieces) difference(piece, zone, out);
    return out;
}

template <class Z>
bool one_includes(const Zones<Z>& zones, const Z& zone) {
    attend(zones.size() * BOUNDS<Z>);
    for (const Z& z : zones)
        if (includes(z, zone)) return true;
    return false;
}

// The points of the zone that are in none of the others.
template <class Z>
Zones<Z> outside(const Z& zone, const Zones<Z>& others, Watch& watch) {
    if (one_includes(others, zone)) return {};
    Zones<Z> rest{zone};
    for (const Z& other : others) {
        if (clearly_disjoint(zone, other)) continue;
        rest = without(rest, other, watch);
        if (rest.empty()) break;
    }
    return rest;
}

// The same points in fewer zones where two make one.
template <class Z>
Zones<Z> merged(const Zones<Z>& zones, Watch& watch) {
    Zones<Z> result;
    for (Z zone : zones) {
        watch.tick();
        for (std::size_t k = 0; k < result.size();) {
            const Z& other = result[k];
            if (includes(other, zone)) {
                zone = other;
            } else if (!includes(zone, other)) {
                if (!joins(zone, other)) {
                    ++k;
                    continue;
                }
                zone = hull(zone, other);
            }
            result.erase(result.begin() + static_cast<std::ptrdiff_t>(k));
            k = 0;
        }
        result.push_back(zone);
    }
    return result;
}

}  // namespace pursue::proof
