// Zones as difference bound matrices (Bengtsson and Yi 2004): free functions on a canonical, non-empty matrix.
//
// m[i * N + j] bounds x_i - x_j; x_0 is the constant 0. A bound is raw = 2 * c + (1 if "<=" else 0), so that a smaller
// raw bound is the tighter one. N is fixed when compiled; unused clocks stay unconstrained and cost next to nothing.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <vector>

namespace pursue {

using raw_t = std::int32_t;

constexpr raw_t INF = 1 << 29;
constexpr raw_t LE_ZERO = 1;
constexpr raw_t LT_ZERO = 0;

// The sum of two bounds; infinite as soon as one is.
inline raw_t add(raw_t a, raw_t b) { return (a >= INF || b >= INF) ? INF : a + b - ((a | b) & 1); }

// The bound of the complement: not (x - y < c) is y - x <= -c.
inline raw_t complement(raw_t a) {
    assert(a < INF);
    return 1 - a;
}

template <int N>
struct Dbm {
    raw_t m[N * N];

    raw_t& at(int i, int j) { return m[i * N + j]; }
    raw_t at(int i, int j) const { return m[i * N + j]; }
};

// All valuations: every clock >= 0.
template <int N>
Dbm<N> universe() {
    Dbm<N> z;
    for (int i = 0; i < N; ++i)
        for (int j = 0; j < N; ++j) z.at(i, j) = (i == j || i == 0) ? LE_ZERO : INF;
    return z;
}

// The first `clocks` clocks are 0, the others (padding) free.
template <int N>
Dbm<N> origin(int clocks) {
    assert(clocks < N);
    Dbm<N> z = universe<N>();
    for (int i = 0; i <= clocks; ++i)
        for (int j = 0; j <= clocks; ++j) z.at(i, j) = LE_ZERO;
    for (int i = 1; i <= clocks; ++i)
        for (int j = clocks + 1; j < N; ++j) z.at(i, j) = LE_ZERO;
    return z;
}

// Requires: canonical. Ensures: true and canonical with x_i - x_j within `bound`, or false (empty, z is not to be used).
template <int N>
bool constrain(Dbm<N>& z, int i, int j, raw_t bound) {
    assert(i != j);
    if (bound >= z.at(i, j)) return true;
    if (add(z.at(j, i), bound) < LE_ZERO) return false;
    z.at(i, j) = bound;
    for (int k = 0; k < N; ++k) {
        const raw_t through = add(z.at(k, i), bound);
        if (through >= z.at(k, j)) continue;
        z.at(k, j) = through;
        for (int l = 0; l < N; ++l) z.at(k, l) = std::min(z.at(k, l), add(through, z.at(j, l)));
    }
    for (int l = 0; l < N; ++l) z.at(i, l) = std::min(z.at(i, l), add(bound, z.at(j, l)));
    return true;
}

// Tightens all bounds (Floyd and Warshall). Returns false when empty.
template <int N>
bool close(Dbm<N>& z) {
    for (int k = 0; k < N; ++k)
        for (int i = 0; i < N; ++i) {
            const raw_t ik = z.at(i, k);
            if (ik >= INF || i == k) continue;
            for (int j = 0; j < N; ++j) z.at(i, j) = std::min(z.at(i, j), add(ik, z.at(k, j)));
            if (z.at(i, i) < LE_ZERO) return false;
        }
    return true;
}

// Quick test, exact in one direction only: true means disjoint.
template <int N>
bool clearly_disjoint(const Dbm<N>& a, const Dbm<N>& b) {
    for (int i = 0; i < N; ++i)
        for (int j = 0; j < N; ++j)
            if (i != j && add(a.at(i, j), b.at(j, i)) < LE_ZERO) return true;
    return false;
}

// Requires: both canonical. Ensures: a is the canonical intersection and true, or false (empty).
template <int N>
bool intersect(Dbm<N>& a, const Dbm<N>& b) {
    if (clearly_disjoint(a, b)) return false;
    bool changed = false;
    for (int k = 0; k < N * N; ++k)
        if (b.m[k] < a.m[k]) {
            a.m[k] = b.m[k];
            changed = true;
        }
    return !changed || close(a);
}

template <int N>
bool includes(const Dbm<N>& big, const Dbm<N>& small) {
    for (int k = 0; k < N * N; ++k)
        if (small.m[k] > big.m[k]) return false;
    return true;
}

// The smallest zone around both.
template <int N>
Dbm<N> hull(Dbm<N> a, const Dbm<N>& b) {
    for (int k = 0; k < N * N; ++k) a.m[k] = std::max(a.m[k], b.m[k]);
    return a;
}

// The future: time passes.
template <int N>
void up(Dbm<N>& z) {
    for (int i = 1; i < N; ++i) z.at(i, 0) = INF;
}

// The past: every valuation from which some delay leads into z.
template <int N>
void down(Dbm<N>& z) {
    for (int j = 1; j < N; ++j) z.at(0, j) = LE_ZERO;
    for (int j = 1; j < N; ++j)
        for (int i = 1; i < N; ++i) z.at(0, j) = std::min(z.at(0, j), z.at(i, j));
}

// The past by at most `delay` time units (scaled). Valuations below zero are cut off.
template <int N>
bool down_within(Dbm<N>& z, raw_t delay) {
    if (delay == 0) return true;
    raw_t low[N];
    for (int j = 1; j < N; ++j) low[j] = add(z.at(0, j), 2 * delay + 1);
    for (int j = 1; j < N; ++j) z.at(0, j) = low[j];
    // the shifted zone is canonical but may reach below zero
    for (int j = 1; j < N; ++j)
        if (!constrain(z, 0, j, LE_ZERO)) return false;
    return true;
}

// The future by at most `delay`.
template <int N>
void up_within(Dbm<N>& z, raw_t delay) {
    for (int i = 1; i < N; ++i) z.at(i, 0) = add(z.at(i, 0), 2 * delay + 1);
}

// x_i := 0.
template <int N>
void reset(Dbm<N>& z, int i) {
    for (int j = 0; j < N; ++j) {
        z.at(i, j) = z.at(0, j);
        z.at(j, i) = z.at(j, 0);
    }
    z.at(i, i) = LE_ZERO;
}

// x_i may be anything >= 0.
template <int N>
void free_clock(Dbm<N>& z, int i) {
    for (int j = 0; j < N; ++j) {
        if (j == i) continue;
        z.at(i, j) = INF;
        z.at(j, i) = z.at(j, 0);
    }
}

// Forgets what lies above the largest constants (Extra_M), scaled; index 0 is unused, a clock with -1 is freed.
template <int N>
void extrapolate(Dbm<N>& z, const std::vector<raw_t>& max) {
    bool changed = false;
    for (int x = 1; x < N; ++x)
        if (max[x] < 0) free_clock(z, x);
    for (int i = 0; i < N; ++i)
        for (int j = 0; j < N; ++j) {
            if (i == j) continue;
            raw_t& b = z.at(i, j);
            if (i > 0 && max[i] >= 0 && b < INF && b > 2 * max[i] + 1) {
                b = INF;
                changed = true;
            } else if (j > 0 && max[j] >= 0 && b < -2 * max[j]) {
                b = -2 * max[j];
                changed = true;
            }
        }
    if (changed) close(z);
}

// Appends the parts of a outside b, pairwise disjoint.
template <int N>
void subtract(const Dbm<N>& a, const Dbm<N>& b, std::vector<Dbm<N>>& out) {
    if (clearly_disjoint(a, b)) {
        out.push_back(a);
        return;
    }
    Dbm<N> rest = a;
    for (int i = 0; i < N; ++i)
        for (int j = 0; j < N; ++j) {
            if (i == j || b.at(i, j) >= rest.at(i, j)) continue;
            Dbm<N> part = rest;
            if (constrain(part, j, i, complement(b.at(i, j)))) out.push_back(part);
            if (!constrain(rest, i, j, b.at(i, j))) return;
        }
}

}  // namespace pursue
