// The fewest bounds that make a zone.
#pragma once

#include <tuple>
#include <vector>

#include "zones/native/dbm.hpp"

namespace pursue {

// The bounds of a zone that the others, and clocks being >= 0, do not imply (the twin of strategy_from.minimal: Larsen,
// Larsson, Pettersson and Yi 1997), row by row.
template <class Z>
std::vector<std::tuple<int, int, typename Z::raw_t>> minimal(const Z& zone, int dim) {
    const auto fixed = [&](int i, int j) { return zone.at(i, j) + zone.at(j, i) == 2 && (zone.at(i, j) & 1); };
    std::vector<int> first(dim);
    std::vector<bool> from_zero(dim, false);
    for (int i = 0; i < dim; ++i)
        for (first[i] = 0; first[i] < i && !fixed(i, first[i]);) ++first[i];
    for (int k = 1; k < dim; ++k)
        if (zone.at(0, k) == LE_ZERO) from_zero[first[k]] = true;
    const auto implied = [&](int i, int j) {
        for (int k = 0; k < dim; ++k) {
            if (first[k] != k || k == i || k == j) continue;
            const auto there = zone.at(i, k), on = zone.at(k, j);
            if (there < INF<typename Z::raw_t> && on < INF<typename Z::raw_t> && add(there, on) <= zone.at(i, j)) return true;
        }
        return false;
    };
    std::vector<std::tuple<int, int, typename Z::raw_t>> kept;
    for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) {
            const auto bound = zone.at(i, j);
            if (i == j || bound >= INF<typename Z::raw_t> || (i == 0 && (bound == LE_ZERO || from_zero[j]))) continue;
            const bool one_class = first[i] == first[j];
            const bool keep = one_class ? first[i] == i || first[i] == j : first[i] == i && first[j] == j && !implied(i, j);
            if (keep) kept.emplace_back(i, j, bound);
        }
    return kept;
}

}  // namespace pursue
