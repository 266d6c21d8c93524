// Federations: finite unions of zones, as vectors (they may overlap unless said otherwise).
#pragma once

#include <utility>

#include "dbm.hpp"

namespace pursue {

template <class Z>
using Federation = std::vector<Z>;

template <class Z>
Federation<Z> minus(const Federation<Z>& fed, const Z& zone) {
    Federation<Z> out;
    out.reserve(fed.size() + 2);
    for (const auto& z : fed) subtract(z, zone, out);
    return out;
}

template <class Z>
bool touches(const Federation<Z>& fed, const Z& zone) {
    for (const auto& z : fed)
        if (!clearly_disjoint(z, zone)) return true;
    return false;
}

template <class Z>
Federation<Z> minus(Federation<Z> fed, const Federation<Z>& other) {
    for (const auto& zone : other) {
        if (fed.empty()) break;
        if (touches(fed, zone)) fed = minus(fed, zone);
    }
    return fed;
}

template <class Z>
Federation<Z> intersection(const Federation<Z>& a, const Federation<Z>& b) {
    Federation<Z> out;
    for (const auto& zone : b)
        for (const auto& other : a) {
            out.push_back(other);
            if (!intersect(out.back(), zone)) out.pop_back();
        }
    return out;
}

template <class Z>
void append(Federation<Z>& a, const Federation<Z>& b) {
    a.insert(a.end(), b.begin(), b.end());
}

// Adds a zone unless one that is there includes it; drops those that it includes.
template <class Z>
void insert(Federation<Z>& fed, const Z& zone) {
    for (const auto& z : fed)
        if (includes(z, zone)) return;
    fed.erase(std::remove_if(fed.begin(), fed.end(), [&](const Z& z) { return includes(zone, z); }), fed.end());
    fed.push_back(zone);
}

// True when between a and b lies a gap, so that their union cannot be convex.
template <class Z>
bool apart(const Z& a, const Z& b) {
    for (int i = 0; i < Z::size; ++i)
        for (int j = 0; j < Z::size; ++j) {
            const int p = a.at(i, j), q = b.at(j, i);
            if ((p >> 1) + (q >> 1) + ((p | q) & 1) <= 0 && i != j) return true;
        }
    return false;
}

// True when a and b together are exactly their hull, which is put into `whole`.
template <class Z>
bool joins(const Z& a, const Z& b, Z& whole) {
    if (apart(a, b)) return false;
    whole = hull(a, b);
    Z rest = whole;
    for (int i = 0; i < Z::size; ++i)
        for (int j = 0; j < Z::size; ++j) {
            if (i == j || a.at(i, j) >= rest.at(i, j)) continue;
            Z part = rest;
            if (constrain(part, j, i, complement(a.at(i, j))) && !includes(b, part)) return false;
            if (!constrain(rest, i, j, a.at(i, j))) return true;
        }
    return true;
}

// Adds a zone, merged with all that it forms a convex union with.
template <class Z>
void absorb(Federation<Z>& fed, Z zone) {
    for (std::size_t k = 0; k < fed.size();) {
        Z whole;
        if (includes(fed[k], zone)) {
            whole = fed[k];
        } else if (!joins(fed[k], zone, whole)) {
            ++k;
            continue;
        }
        zone = whole;
        fed[k] = fed.back();
        fed.pop_back();
        k = 0;
    }
    fed.push_back(zone);
}

// The same set in fewer zones: drops what is included, merges pairs whose union is convex.
template <class Z>
Federation<Z> reduced(const Federation<Z>& fed) {
    Federation<Z> out;
    out.reserve(fed.size());
    for (const auto& zone : fed) absorb(out, zone);
    return out;
}

template <class Z>
bool contains(const Federation<Z>& big, const Z& zone) {
    for (const auto& z : big)
        if (includes(z, zone)) return true;
    return minus(Federation<Z>{zone}, big).empty();
}

// { q | some t >= 0: q+t in good, and q+t' not in bad for all t' in [0, t] } (Cassez et al. 2005).
template <class Z>
Federation<Z> predt(const Federation<Z>& good, const Federation<Z>& bad) {
    constexpr std::size_t many = 4;
    Federation<Z> out;
    for (const auto& g : good) {
        Z past = g;
        down(past);
        Federation<Z> safe{past};
        for (const auto& b : bad) {
            if (safe.empty()) break;
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

// { q | q+t' in fed for all t' in [0, delay] }.
template <class Z>
Federation<Z> lasting(const Federation<Z>& fed, int delay) {
    if (delay == 0) return fed;
    Federation<Z> out;
    for (const auto& zone : fed) {
        Z later = zone;
        up_within(later, delay);
        Federation<Z> good{zone};
        for (auto z : minus(Federation<Z>{later}, fed)) {
            if (down_within(z, delay)) good = minus(good, z);
            if (good.empty()) break;
        }
        append(out, good);
    }
    return out;
}

}  // namespace pursue
