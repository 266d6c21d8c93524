// Zones as difference bound matrices (Bengtsson and Yi 2004): free functions on a canonical, non-empty matrix.
//
// at(i, j) bounds x_i - x_j; x_0 is the constant 0. A bound is raw = 2 * c + (1 if "<=" else 0), so that a smaller raw
// bound is the tighter one. The size N and the integer R of the bounds are fixed when compiled; clocks that a game does
// not have stay unconstrained. Rows are padded with INF to whole vectors of eight bounds: compilers work on rows at once.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <vector>

namespace pursue {

using wide_t = std::int32_t;  // bounds as the tables of a game hold them

// No bound. Two finite bounds add up without overflow, and INF plus a finite bound stays above zero.
template <class R>
constexpr R INF = static_cast<R>(R{1} << (sizeof(R) == 2 ? 14 : 29));

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

// All valuations: every clock >= 0.
template <class Z>
Z universe() {
    Z z;
    std::fill(std::begin(z.m), std::end(z.m), INF<typename Z::raw_t>);
    for (int i = 0; i < Z::size; ++i) z.at(0, i) = z.at(i, i) = LE_ZERO;
    return z;
}

// The first `clocks` clocks are 0, the others (padding) free.
template <class Z>
Z origin(int clocks) {
    assert(clocks < Z::size);
    Z z = universe<Z>();
    for (int i = 0; i <= clocks; ++i)
        for (int j = 0; j < Z::size; ++j) z.at(i, j) = LE_ZERO;
    return z;
}

// row := min(row, base + other), bound by bound.
template <class Z>
inline void relax(typename Z::raw_t* row, typename Z::raw_t base, const typename Z::raw_t* other) {
    using R = typename Z::raw_t;
    for (int l = 0; l < Z::stride; ++l) {
        const R through = add(base, other[l]);
        row[l] = std::min(row[l], through);
    }
}

// Requires: canonical. Ensures: true and canonical with x_i - x_j within `bound`, or false (empty, z is not to be used).
template <class Z>
bool constrain(Z& z, int i, int j, typename Z::raw_t bound) {
    using R = typename Z::raw_t;
    assert(i != j);
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

// Tightens all bounds (Floyd and Warshall). Returns false when empty.
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
    return true;
}

// Quick test, exact in one direction only: true means disjoint.
template <class Z>
bool clearly_disjoint(const Z& a, const Z& b) {
    for (int i = 0; i < Z::size; ++i)
        for (int j = 0; j < Z::size; ++j) {
            const int p = a.at(i, j), q = b.at(j, i);
            if (p + q - ((p | q) & 1) < LE_ZERO) return true;
        }
    return false;
}

// Requires: both canonical. Ensures: a is the canonical intersection and true, or false (empty).
template <class Z>
bool intersect(Z& a, const Z& b) {
    if (clearly_disjoint(a, b)) return false;
    bool changed = false;
    for (int k = 0; k < Z::size * Z::stride; ++k) {
        changed |= b.m[k] < a.m[k];
        a.m[k] = std::min(a.m[k], b.m[k]);
    }
    return !changed || close(a);
}

template <class Z>
bool includes(const Z& big, const Z& small) {
    bool outside = false;
    for (int k = 0; k < Z::size * Z::stride; ++k) outside |= small.m[k] > big.m[k];
    return !outside;
}

// The smallest zone around both.
template <class Z>
Z hull(Z a, const Z& b) {
    for (int k = 0; k < Z::size * Z::stride; ++k) a.m[k] = std::max(a.m[k], b.m[k]);
    return a;
}

// The future: time passes.
template <class Z>
void up(Z& z) {
    for (int i = 1; i < Z::size; ++i) z.at(i, 0) = INF<typename Z::raw_t>;
}

// The past: every valuation from which some delay leads into z.
template <class Z>
void down(Z& z) {
    for (int j = 1; j < Z::size; ++j) z.at(0, j) = LE_ZERO;
    for (int i = 1; i < Z::size; ++i)
        for (int j = 1; j < Z::stride; ++j) z.at(0, j) = std::min(z.at(0, j), z.at(i, j));
}

// The past by at most `delay` (scaled time). Valuations below zero are cut off; false: nothing is left.
template <class Z>
bool down_within(Z& z, int delay) {
    using R = typename Z::raw_t;
    if (delay == 0) return true;
    for (int j = 1; j < Z::size; ++j) z.at(0, j) = add(z.at(0, j), static_cast<R>(2 * delay + 1));
    // the shifted zone is canonical but may reach below zero
    for (int j = 1; j < Z::size; ++j)
        if (!constrain(z, 0, j, LE_ZERO)) return false;
    return true;
}

// The future by at most `delay` (scaled time).
template <class Z>
void up_within(Z& z, int delay) {
    using R = typename Z::raw_t;
    for (int i = 1; i < Z::size; ++i) z.at(i, 0) = add(z.at(i, 0), static_cast<R>(2 * delay + 1));
}

// x_i := 0.
template <class Z>
void reset(Z& z, int i) {
    std::copy(z.row(0), z.row(0) + Z::stride, z.row(i));
    for (int j = 0; j < Z::size; ++j) z.at(j, i) = z.at(j, 0);
    z.at(i, i) = LE_ZERO;
}

// x_i may be anything >= 0.
template <class Z>
void free_clock(Z& z, int i) {
    std::fill(z.row(i), z.row(i) + Z::stride, INF<typename Z::raw_t>);
    for (int j = 0; j < Z::size; ++j) z.at(j, i) = z.at(j, 0);
    z.at(i, i) = LE_ZERO;
}

// Forgets what lies above the largest constants (Extra_M), scaled; index 0 is unused, a clock with -1 is freed.
template <class Z>
void extrapolate(Z& z, const std::vector<wide_t>& max) {
    using R = typename Z::raw_t;
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
}

// Appends the parts of a outside b, pairwise disjoint.
template <class Z>
void subtract(const Z& a, const Z& b, std::vector<Z>& out) {
    if (clearly_disjoint(a, b)) {
        out.push_back(a);
        return;
    }
    Z rest = a;
    for (int i = 0; i < Z::size; ++i)
        for (int j = 0; j < Z::size; ++j) {
            if (i == j || b.at(i, j) >= rest.at(i, j)) continue;
            out.push_back(rest);
            if (!constrain(out.back(), j, i, complement(b.at(i, j)))) out.pop_back();
            if (!constrain(rest, i, j, b.at(i, j))) return;
        }
}

}  // namespace pursue
