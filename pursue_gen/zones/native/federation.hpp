// Federations: finite unions of zones, as vectors. Zones may overlap unless a function says otherwise; no zone: no point.
//
// Every function requires zones as `dbm.hpp` has them, and ensures them. Those whose work grows with the number of zones
// call `spend`, and all call `attend`: so they may throw what the hooks of these throw.
#pragma once

#include <optional>
#include <utility>

#include "zones/native/dbm.hpp"
#include "zones/native/effort.hpp"

namespace pursue {

template <class Z>
using Federation = std::vector<Z>;

// The points of fed that are not in the zone. Ensures: parts of one zone are disjoint, so a disjoint fed stays disjoint.
template <class Z>
Federation<Z> minus(const Federation<Z>& fed, const Z& zone) {
    spend(fed.size());
    Federation<Z> out;
    out.reserve(fed.size() + 2);
    for (const auto& z : fed) subtract(z, zone, out);
    return out;
}

// Whether one of fed may meet the zone: false means disjoint, see clearly_disjoint.
template <class Z>
bool touches(const Federation<Z>& fed, const Z& zone) {
    attend(fed.size() * BOUNDS<Z>);
    for (const auto& z : fed)
        if (!clearly_disjoint(z, zone)) return true;
    return false;
}

// The points of fed that are not in the other.
template <class Z>
Federation<Z> minus(Federation<Z> fed, const Federation<Z>& other) {
    for (const auto& zone : other) {
        if (fed.empty()) break;
        spend(1);
        if (touches(fed, zone)) fed = minus(fed, zone);
    }
    return fed;
}

// The points in both. Ensures: disjoint if both are.
template <class Z>
Federation<Z> intersection(const Federation<Z>& a, const Federation<Z>& b) {
    Federation<Z> out;
    for (const auto& zone : b) {
        spend(a.size());
        attend(a.size());
        for (const auto& other : a) {
            if (clearly_disjoint(other, zone)) continue;
            out.push_back(other);
            if (!intersect_near(out.back(), zone)) out.pop_back();
        }
    }
    return out;
}

// Ensures: a holds the points of either. Requires: two objects.
template <class Z>
void append(Federation<Z>& a, const Federation<Z>& b) {
    assert(&a != &b);
    a.insert(a.end(), b.begin(), b.end());
}

// Adds a zone unless one that is there includes it; drops those that it includes. Ensures: none includes another, if that
// was so before.
template <class Z>
void insert(Federation<Z>& fed, const Z& zone) {
    spend(fed.size());
    attend(fed.size() * BOUNDS<Z>);
    for (const auto& z : fed)
        if (includes(z, zone)) return;
    fed.erase(std::remove_if(fed.begin(), fed.end(), [&](const Z& z) { return includes(zone, z); }), fed.end());
    fed.push_back(zone);
}

// A bound (i, j) of one zone and one (k, l) of another that keep them from joining; at first none.
struct Apart {
    int i = 0, j = 0, k = 0, l = 0;
};

// Whether the hull of a and b has points beyond them that break the bound (i, j) of a and (k, l) of b, which are tighter
// there than the other's. As the hull is canonical, it has none iff the one cycle through both broken bounds is negative.
template <class Z>
inline bool apart(const Z& a, const Z& b, const Apart& by) {
    const auto [i, j, k, l] = by;
    if (a.at(i, j) >= b.at(i, j) || b.at(k, l) >= a.at(k, l)) return false;
    const typename Z::raw_t p = complement(a.at(i, j)), q = complement(b.at(k, l));
    const typename Z::raw_t r = std::max(a.at(i, l), b.at(i, l)), s = std::max(a.at(k, j), b.at(k, j));
    return (p >> 1) + (q >> 1) + (r >> 1) + (s >> 1) + (p & q & r & s & 1) > 0;
}

// What keeps a and b from joining; none if they together are exactly their hull, as all that it has beyond them breaks a
// bound that is tighter in a and one that is tighter in b.
template <class Z>
std::optional<Apart> what_parts(const Z& a, const Z& b) {
    attend(BOUNDS<Z>);
    struct {
        short i, j;
    } tighter_a[Z::size * Z::size], tighter_b[Z::size * Z::size];  // not set: that would take longer than the rest
    int count_a = 0, count_b = 0;
    for (int i = 0; i < Z::size; ++i)
        for (int j = 0; j < Z::size; ++j) {
            if (a.at(i, j) < b.at(i, j)) {
                for (int n = 0; n < count_b; ++n) {
                    const Apart by{i, j, tighter_b[n].i, tighter_b[n].j};
                    if (apart(a, b, by)) return by;
                }
                tighter_a[count_a++] = {short(i), short(j)};
            } else if (b.at(i, j) < a.at(i, j)) {
                for (int n = 0; n < count_a; ++n) {
                    const Apart by{tighter_a[n].i, tighter_a[n].j, i, j};
                    if (apart(a, b, by)) return by;
                }
                tighter_b[count_b++] = {short(i), short(j)};
            }
        }
    return std::nullopt;
}

// Whether a and b together are exactly their hull.
template <class Z>
bool joins(const Z& a, const Z& b) {
    return !what_parts(a, b);
}

// Adds a zone, merged with all that it forms a convex union with. Ensures: no two of fed form one, if that was so before.
template <class Z>
void absorb(Federation<Z>& fed, Z zone) {
    Apart last, other;  // what kept two zones apart: in a row of zones it is often the same
    for (bool again = true; again;) {
        again = false;
        spend(fed.size());
        for (std::size_t k = 0; k < fed.size();) {
            if (apart(fed[k], zone, last) || apart(fed[k], zone, other)) {
                attend(1);
                ++k;
                continue;
            }
            if (const std::optional<Apart> by = what_parts(fed[k], zone)) {
                other = std::exchange(last, *by);
                ++k;
                continue;
            }
            zone = hull(zone, fed[k]);
            fed[k] = fed.back();
            fed.pop_back();
            again = true;
        }
    }
    fed.push_back(zone);
}

// The same set in fewer zones. Ensures: no two of them have a convex union, so none includes another.
template <class Z>
Federation<Z> reduced(const Federation<Z>& fed) {
    Federation<Z> out;
    out.reserve(fed.size());
    for (const auto& zone : fed) absorb(out, zone);
    return out;
}

template <class Z>
Federation<Z> reduced(Federation<Z>&& fed) {
    if (fed.size() < 2) return std::move(fed);
    return reduced(std::as_const(fed));
}

// The same set in pairwise disjoint zones.
template <class Z>
Federation<Z> disjoint(const Federation<Z>& fed) {
    Federation<Z> out;
    for (const Z& zone : reduced(fed)) append(out, minus(Federation<Z>{zone}, out));
    return out;
}

// Whether every point of the zone is in one of big.
template <class Z>
bool contains(const Federation<Z>& big, const Z& zone) {
    attend(big.size() * BOUNDS<Z>);
    for (const auto& z : big)
        if (includes(z, zone)) return true;
    return minus(Federation<Z>{zone}, big).empty();
}

// What is in the zone and within the bounds that each clock has in the parts, whatever the differences of clocks.
// Requires: at least one part, all of them in the zone. Ensures: a zone that includes the parts.
template <class Z>
Z boxed(Z zone, const Federation<Z>& parts) {
    assert(!parts.empty());
    Z whole = parts[0];
    attend(parts.size() * BOUNDS<Z>);
    for (const Z& part : parts) whole = hull(whole, part);
    for (int x = 1; x < Z::size; ++x) {
        constrain(zone, 0, x, whole.at(0, x));
        constrain(zone, x, 0, whole.at(x, 0));
    }
    check(zone);
    return zone;
}

// The points of the zone that are outside of `inner`, in zones as large as can be, which may overlap.
template <class Z>
Federation<Z> around(const Z& zone, const Z& inner) {
    Federation<Z> out;
    // Bounds on clocks first: those on differences often follow from them.
    Z rest = zone;
    const auto cut = [&](int i, int j) {
        if (i == j || inner.at(i, j) >= rest.at(i, j)) return true;
        attend(BOUNDS<Z>);
        out.push_back(zone);
        if (!constrain(out.back(), j, i, complement(inner.at(i, j)))) out.pop_back();
        return constrain(rest, i, j, inner.at(i, j));
    };
    for (int x = 1; x < Z::size; ++x)
        if (!cut(0, x) || !cut(x, 0)) return {zone};
    for (int i = 1; i < Z::size; ++i)
        for (int j = 1; j < Z::size; ++j)
            if (!cut(i, j)) return {zone};
    return out;
}

// { q | some t >= 0: q+t in good, and q+t' not in bad for all t' in [0, t] } (Cassez et al. 2005).
template <class Z>
Federation<Z> predt(const Federation<Z>& good, const Federation<Z>& bad) {
    constexpr std::size_t many = 4;
    Federation<Z> out;
    out.reserve(good.size());
    for (const auto& g : good) {
        Z past = g;
        down(past);
        if (bad.empty()) {
            out.push_back(past);
            continue;
        }
        Federation<Z> safe{past};
        spend(bad.size());
        for (const auto& b : bad) {
            if (safe.empty()) break;
            attend(BOUNDS<Z>);
            if (clearly_disjoint(past, b)) continue;
            Z before = b;
            down(before);
            Federation<Z> part = minus(Federation<Z>{past}, before);
            Z in = g;
            if (intersect(in, before)) {
                Federation<Z> early;
                subtract(in, b, early);
                for (auto& z : early) {
                    down(z);
                    part.push_back(z);
                }
            }
            safe = intersection(safe, part);
            if (safe.size() > many) safe = reduced(safe);
        }
        append(out, safe);
    }
    return out;
}

// { q | q+t' in fed for all t' in [0, delay] }. Requires: delay >= 0.
template <class Z>
Federation<Z> lasting(const Federation<Z>& fed, int delay) {
    assert(delay >= 0);
    if (delay == 0) return fed;
    Federation<Z> out;
    for (const auto& zone : fed) {
        Z later = zone;
        up_within(later, delay);
        spend(1);
        Federation<Z> good{zone};
        for (auto z : minus(Federation<Z>{later}, fed)) {
            attend(BOUNDS<Z>);
            if (down_within(z, delay)) good = minus(good, z);
            if (good.empty()) break;
        }
        append(out, good);
    }
    return out;
}

}  // namespace pursue
