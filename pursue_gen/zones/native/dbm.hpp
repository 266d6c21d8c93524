// Zones as difference bound matrices (Bengtsson and Yi 2004): free functions on a canonical, non-empty matrix.
//
// Every function requires that of the zones that it is given, and ensures it of those that it gives back, unless it says
// otherwise; with PURSUE_CHECKED defined both are asserted. Where a function returns false its zone is not to be used.
//
// at(i, j) bounds x_i - x_j; x_0 is the constant 0. A bound is raw = 2 * c + (1 if "<=" else 0), so that a smaller raw
// bound is the tighter one. The size N and the integer R of the bounds are fixed when compiled; clocks that a game does
// not have stay unconstrained. Rows are padded with INF to whole vectors of eight bounds: compilers work on rows at once.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <vector>

#include "zones/native/effort.hpp"

namespace pursue {

using wide_t = std::int32_t;  // bounds as the tables of a game hold them

// No bound. Two finite bounds add up without overflow, and INF plus a finite bound stays above zero.
template <class R>
constexpr R INF = static_cast<R>(R{1} << (sizeof(R) == 2 ? 14 : sizeof(R) == 4 ? 29 : 60));

constexpr int LE_ZERO = 1;

// The sum of two bounds; infinite as soon as one is.
template <class R>
inline R add(R a, R b) {
    return std::max(a, b) >= INF<R> ? INF<R> : static_cast<R>(a + b - ((a | b) & 1));
}

// The bound of the complement: not (x - y < c) is y - x <= -c.
template <class R>
inline R complement(R a) {
    assert(a < INF<R>);
    return static_cast<R>(1 - a);
}

template <int N, class R>
struct Dbm {
    using raw_t = R;
    static constexpr int size = N, stride = (N + 7) / 8 * 8;

    R m[N * stride];

    R* row(int i) { return m + i * stride; }
    const R* row(int i) const { return m + i * stride; }
    R& at(int i, int j) { return m[i * stride + j]; }
    R at(int i, int j) const { return m[i * stride + j]; }
};

// The bounds of a zone, as `attend` counts them.
template <class Z>
constexpr std::size_t BOUNDS = Z::size * Z::size;

// Whether the diagonal is `<= 0`, every clock >= 0, and no bound is wider than a way round through a third clock.
template <class Z>
bool is_canonical(const Z& z) {
    for (int i = 0; i < Z::size; ++i) {
        if (z.at(i, i) != LE_ZERO) return false;
        // No bound at all: padding of which a policy knows nothing, see synthesis/native/forward.hpp.
        if (z.at(0, i) > LE_ZERO && z.at(0, i) < INF<typename Z::raw_t>) return false;
        for (int j = 0; j < Z::size; ++j)
            for (int k = 0; k < Z::size; ++k)
                if (z.at(i, j) > add(z.at(i, k), z.at(k, j))) return false;
    }
    return true;
}

// The contract of the functions below; too slow for any but a checked build.
template <class Z>
inline void check([[maybe_unused]] const Z& z) {
#ifdef PURSUE_CHECKED
    assert(is_canonical(z));
#endif
}

template <class Z>
inline bool is_clock(int i) {
    return 0 < i && i < Z::size;
}

// All valuations: every clock >= 0.
template <class Z>
Z universe() {
    Z z;
    std::fill(std::begin(z.m), std::end(z.m), INF<typename Z::raw_t>);
    for (int i = 0; i < Z::size; ++i) z.at(0, i) = z.at(i, i) = LE_ZERO;
    return z;
}

// The first `clocks` clocks are 0, the others (padding) free. Requires: 0 <= clocks < Z::size.
template <class Z>
Z origin(int clocks) {
    assert(0 <= clocks && clocks < Z::size);
    Z z = universe<Z>();
    for (int i = 0; i <= clocks; ++i)
        for (int j = 0; j < Z::size; ++j) z.at(i, j) = LE_ZERO;
    check(z);
    return z;
}

// row := min(row, base + other), bound by bound. Requires: rows of Z::stride bounds.
template <class Z>
inline void relax(typename Z::raw_t* row, typename Z::raw_t base, const typename Z::raw_t* other) {
    using R = typename Z::raw_t;
    for (int l = 0; l < Z::stride; ++l) {
        const R through = add(base, other[l]);
        row[l] = std::min(row[l], through);
    }
}

// Takes a bound in. Ensures: the points of z with x_i - x_j within `bound`, and true; or false: none. The clocks of z may
// be below zero (see down_within).
template <class Z>
bool constrain(Z& z, int i, int j, typename Z::raw_t bound) {
    using R = typename Z::raw_t;
    assert(0 <= i && i < Z::size && 0 <= j && j < Z::size);
    if (bound >= z.at(i, j)) return true;
    if (add(z.at(j, i), bound) < LE_ZERO) return false;
    R way[Z::stride];  // from i by way of j
    for (int l = 0; l < Z::stride; ++l) way[l] = add(bound, z.at(j, l));
    for (int k = 0; k < Z::size; ++k) {
        const R to = z.at(k, i);
        if (to < INF<R> && add(to, bound) < z.at(k, j)) relax<Z>(z.row(k), to, way);
    }
    return true;
}

// Makes z canonical (Floyd and Warshall). Requires: a diagonal of `<= 0`. Ensures: the same points, and true; or false:
// none.
template <class Z>
bool close(Z& z) {
    using R = typename Z::raw_t;
    for (int k = 0; k < Z::size; ++k)
        for (int i = 0; i < Z::size; ++i) {
            const R to = z.at(i, k);
            if (to >= INF<R> || i == k) continue;
            relax<Z>(z.row(i), to, z.row(k));
            if (z.at(i, i) < LE_ZERO) return false;
        }
    check(z);
    return true;
}

// Whether one pair of opposite bounds shows that a and b have no point in common. Exact in one direction
// only: true means disjoint.
template <class Z>
bool clearly_disjoint(const Z& a, const Z& b) {
    for (int i = 0; i < Z::size; ++i)
        for (int j = 0; j < Z::size; ++j) {
            const typename Z::raw_t p = a.at(i, j), q = b.at(j, i);
            if (p + q - ((p | q) & 1) < LE_ZERO) return true;
        }
    return false;
}

// As `intersect`. Requires: they are not clearly disjoint.
template <class Z>
bool intersect_near(Z& a, const Z& b) {
    attend(BOUNDS<Z>);
    bool changed = false;
    for (int k = 0; k < Z::size * Z::stride; ++k) {
        changed |= b.m[k] < a.m[k];
        a.m[k] = std::min(a.m[k], b.m[k]);
    }
    return !changed || close(a);
}

// Ensures: a holds the points of both, and true; or false: there are none.
template <class Z>
bool intersect(Z& a, const Z& b) {
    return !clearly_disjoint(a, b) && intersect_near(a, b);
}

// Whether every point of `small` is in `big`: exact, as `small` is canonical.
template <class Z>
bool includes(const Z& big, const Z& small) {
    bool outside = false;
    for (int k = 0; k < Z::size * Z::stride; ++k) outside |= small.m[k] > big.m[k];
    return !outside;
}

// The smallest zone that includes both: canonical, as the larger of two bounds is within the larger of two ways round.
template <class Z>
Z hull(Z a, const Z& b) {
    for (int k = 0; k < Z::size * Z::stride; ++k) a.m[k] = std::max(a.m[k], b.m[k]);
    check(a);
    return a;
}

// The future: every valuation that some delay leads to from z.
template <class Z>
void up(Z& z) {
    for (int i = 1; i < Z::size; ++i) z.at(i, 0) = INF<typename Z::raw_t>;
    check(z);
}

// The past: every valuation from which some delay leads into z.
template <class Z>
void down(Z& z) {
    for (int j = 1; j < Z::size; ++j) z.at(0, j) = LE_ZERO;
    for (int i = 1; i < Z::size; ++i)
        for (int j = 1; j < Z::stride; ++j) z.at(0, j) = std::min(z.at(0, j), z.at(i, j));
    check(z);
}

// The past by at most `delay` (scaled time). Requires: delay >= 0. Ensures: every valuation with clocks >= 0 from which
// a time in [0, delay] leads into z, and true, as those of z are among them.
template <class Z>
bool down_within(Z& z, int delay) {
    using R = typename Z::raw_t;
    assert(delay >= 0);
    if (delay == 0) return true;
    for (int j = 1; j < Z::size; ++j) z.at(0, j) = add(z.at(0, j), static_cast<R>(2 * delay + 1));
    // the shifted zone is canonical but may reach below zero
    for (int j = 1; j < Z::size; ++j)
        if (!constrain(z, 0, j, LE_ZERO)) return false;
    check(z);
    return true;
}

// The future by at most `delay` (scaled time). Requires: delay >= 0. Ensures: what a time in [0, delay] leads to from z.
template <class Z>
void up_within(Z& z, int delay) {
    using R = typename Z::raw_t;
    assert(delay >= 0);
    for (int i = 1; i < Z::size; ++i) z.at(i, 0) = add(z.at(i, 0), static_cast<R>(2 * delay + 1));
    check(z);
}

// x_i := 0. Requires: x_i is a clock. Ensures: the images of the points of z.
template <class Z>
void reset(Z& z, int i) {
    assert(is_clock<Z>(i));
    std::copy(z.row(0), z.row(0) + Z::stride, z.row(i));
    for (int j = 0; j < Z::size; ++j) z.at(j, i) = z.at(j, 0);
    z.at(i, i) = LE_ZERO;
    check(z);
}

// x_i may be anything >= 0. Requires: x_i is a clock. Ensures: every valuation that differs from one of z in x_i only.
template <class Z>
void free_clock(Z& z, int i) {
    assert(is_clock<Z>(i));
    std::fill(z.row(i), z.row(i) + Z::stride, INF<typename Z::raw_t>);
    for (int j = 0; j < Z::size; ++j) z.at(j, i) = z.at(j, 0);
    z.at(i, i) = LE_ZERO;
    check(z);
}

// Extrapolates by the largest constants, scaled (Extra_M, Behrmann et al. 2006). Requires: max[i] for every clock; index
// 0 is unused, a clock with -1 is freed. Ensures: a zone that includes z, and differs only beyond those constants.
template <class Z>
void extrapolate(Z& z, const std::vector<wide_t>& max) {
    using R = typename Z::raw_t;
    assert(max.size() >= static_cast<std::size_t>(Z::size));
    bool changed = false;
    for (int x = 1; x < Z::size; ++x)
        if (max[x] < 0) free_clock(z, x);
    for (int i = 0; i < Z::size; ++i)
        for (int j = 0; j < Z::size; ++j) {
            if (i == j) continue;
            R& b = z.at(i, j);
            if (i > 0 && max[i] >= 0 && b < INF<R> && b > 2 * max[i] + 1) {
                b = INF<R>;
                changed = true;
            } else if (j > 0 && max[j] >= 0 && b < -2 * max[j]) {
                b = static_cast<R>(-2 * max[j]);
                changed = true;
            }
        }
    if (changed) close(z);
    check(z);
}

// Appends the points of a that are not in b, as pairwise disjoint zones. Requires: neither is in `out`.
template <class Z>
void subtract(const Z& a, const Z& b, std::vector<Z>& out) {
    attend(BOUNDS<Z>);
    if (clearly_disjoint(a, b)) {
        out.push_back(a);
        return;
    }
    Z rest = a;
    const auto cut = [&](int i, int j) {
        if (i == j || b.at(i, j) >= rest.at(i, j)) return true;
        attend(BOUNDS<Z>);
        out.push_back(rest);
        if (!constrain(out.back(), j, i, complement(b.at(i, j)))) out.pop_back();
        return constrain(rest, i, j, b.at(i, j));
    };
    // Bounds on single clocks first: those on differences often follow from them, and then cut nothing.
    for (int x = 1; x < Z::size; ++x)
        if (!cut(0, x) || !cut(x, 0)) return;
    for (int i = 1; i < Z::size; ++i)
        for (int j = 1; j < Z::size; ++j)
            if (!cut(i, j)) return;
}

}  // namespace pursue
