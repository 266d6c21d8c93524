// Batteries of robots that are levels: variables.
#pragma once

#include <optional>
#include <set>

#include "game.hpp"

namespace pursue {

// A robot's battery is a variable that each of its ways lowers, and something that it does raises.
struct Battery {
    int level, full;  // index in the discrete state, and the largest value
    std::set<int> charging;  // the locations in which it is raised
};

// By how much an edge changes a variable that it tests, 0: it does not, or in several ways.
inline int change_of(const Edge& edge, int variable) {
    for (const auto& clause : edge.clauses)
        for (const auto& set : edge.assign)
            if (clause.size() == 1 && clause.front().variable == variable && set.variable == variable)
                return set.value - clause.front().value;
    return 0;
}

// The battery of a robot, none: it has none.
inline std::optional<Battery> battery_of(const Game& game, int robot) {
    const auto& edges = game.automata[robot].edges;
    const auto is_way = [&](const Edge& edge) {
        return edge.controllable && std::any_of(edges.begin(), edges.end(), [&](const Edge& end) {
            return end.source == edge.target && end.target != edge.source;
        });
    };
    std::optional<Battery> found;
    for (int variable = 0; variable < static_cast<int>(game.variables.size()); ++variable) {
        Battery battery{static_cast<int>(game.automata.size()) + variable, 0, {}};
        bool lowered = false, otherwise = false;
        for (const Edge& edge : edges) {
            const int by = change_of(edge, variable);
            if (is_way(edge)) (by < 0 ? lowered : otherwise) = true;
            if (by <= 0) continue;
            if (!game.automata[robot].invariants[edge.source].empty()) battery.charging.insert(edge.source);
            for (const auto& set : edge.assign)
                if (set.variable == variable) battery.full = std::max(battery.full, set.value);
        }
        if (!found && lowered && !otherwise && !battery.charging.empty()) found = battery;
    }
    return found;
}

}  // namespace pursue
