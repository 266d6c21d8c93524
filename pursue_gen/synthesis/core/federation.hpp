// Federations: finite unions of zones, as vectors (they may overlap unless said otherwise).
#pragma once

#include <utility>

#include "dbm.hpp"

namespace pursue {

template <int N>
using Federation = std::vector<Dbm<N>>;

template <int N>
Federation<N> minus(const Federation<N>& fed, const Dbm<N>& zone) {
    Federation<N> out;
    out.reserve(fed.size());
    for (const auto& z : fed) subtract(z, zone, out);
    return out;
}

template <int N>
Federation<N> minus(Federation<N> fed, const Federation<N>& other) {
    for (const auto& zone : other) {
        if (fed.empty()) break;
        fed = minus(fed, zone);
    }
    return fed;
}

template <int N>
Federation<N> intersection(const Federation<N>& a, const Dbm<N>& b) {
    Federation<N> out;
    for (auto z : a)
        if (intersect(z, b)) out.push_back(z);
    return out;
}

template <int N>
Federation<N> intersection(const Federation<N>& a, const Federation<N>& b) {
    Federation<N> out;
    for (const auto& zone : b)
        for (auto z : a)
            if (intersect(z, zone)) out.push_back(z);
    return out;
}

template <int N>
void append(Federation<N>& a, const Federation<N>& b) {
    a.insert(a.end(), b.begin(), b.end());
}

// Adds a zone unless one that is there includes it; drops those that it includes.
template <int N>
void insert_reduced(Federation<N>& fed, const Dbm<N>& zone) {
    for (const auto& z : fed)
        if (includes(z, zone)) return;
    fed.erase(std::remove_if(fed.begin(), fed.end(), [&](const Dbm<N>& z) { return includes(zone, z); }), fed.end());
    fed.push_back(zone);
}

// True when between a and b lies a gap, so that their union cannot be convex.
template <int N>
bool apart(const Dbm<N>& a, const Dbm<N>& b) {
    for (int i = 0; i < N; ++i)
        for (int j = 0; j < i; ++j) {
            const raw_t p = a.at(i, j), q = b.at(j, i), r = b.at(i, j), s = a.at(j, i);
            if (p < INF && q < INF && (p >> 1) + (q >> 1) + ((p | q) & 1) <= 0) return true;
            if (r < INF && s < INF && (r >> 1) + (s >> 1) + ((r | s) & 1) <= 0) return true;
        }
    return false;
}

// True when a and b together are exactly their hull, which is put into `whole`.
template <int N>
bool joins(const Dbm<N>& a, const Dbm<N>& b, Dbm<N>& whole) {
    if (apart(a, b)) return false;
    whole = hull(a, b);
    Federation<N> rest;
    subtract(whole, a, rest);
    for (const auto& z : rest)
        if (!includes(b, z)) return false;
    return true;
}

// The same set in fewer zones: drops what is included, merges pairs whose union is convex.
template <int N>
Federation<N> reduced(const Federation<N>& fed) {
    Federation<N> out;
    for (auto zone : fed) {
        bool again = true;
        while (again) {
            again = false;
            for (std::size_t k = 0; k < out.size(); ++k) {
                Dbm<N> whole;
                if (includes(out[k], zone)) {
                    whole = out[k];
                } else if (!joins(out[k], zone, whole)) {
                    continue;
                }
                zone = whole;
                out[k] = out.back();
                out.pop_back();
                again = true;
                break;
            }
        }
        out.push_back(zone);
    }
    return out;
}

template <int N>
bool contains(const Federation<N>& big, const Dbm<N>& zone) {
    for (const auto& z : big)
        if (includes(z, zone)) return true;
    return minus(Federation<N>{zone}, big).empty();
}

// { q | some t >= 0: q+t in good, and q+t' not in bad for all t' in [0, t] } (Cassez et al. 2005).
template <int N>
Federation<N> predt(const Federation<N>& good, const Federation<N>& bad) {
    Federation<N> out;
    for (const auto& g : good) {
        Dbm<N> past = g;
        down(past);
        Federation<N> safe{past};
        for (const auto& b : bad) {
            if (safe.empty()) break;
            if (clearly_disjoint(past, b)) continue;
            Dbm<N> before = b;
            down(before);
            Federation<N> part = minus(Federation<N>{past}, before);
            Dbm<N> in = g;
            if (intersect(in, before)) {
                Federation<N> early;
                subtract(in, b, early);
                for (auto& z : early) {
                    down(z);
                    part.push_back(z);
                }
            }
            safe = intersection(safe, part);
            if (safe.size() > 4) safe = reduced(safe);
        }
        append(out, safe);
    }
    return out;
}

// { q | q+t' in fed for all t' in [0, delay] }.
template <int N>
Federation<N> lasting(const Federation<N>& fed, raw_t delay) {
    if (delay == 0) return fed;
    Federation<N> out;
    for (const auto& zone : fed) {
        Dbm<N> later = zone;
        up_within(later, delay);
        Federation<N> good{zone};
        for (auto z : minus(Federation<N>{later}, fed)) {
            if (down_within(z, delay)) good = minus(good, z);
            if (good.empty()) break;
        }
        append(out, good);
    }
    return out;
}

}  // namespace pursue
