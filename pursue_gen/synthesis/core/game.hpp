// The tables of a game, as the Python side compiles them (pursue_gen/synthesis/game.py says what each field means).
#pragma once

#include <stdexcept>
#include <utility>
#include <vector>

#include "dbm.hpp"

namespace pursue {

struct Bound {
    int i, j;
    raw_t raw;
};

struct Test {
    int variable, value;
};

using Clause = std::vector<Test>;  // any of these

struct Edge {
    int id;  // of the Python side
    int source, target;
    std::vector<Bound> guard;
    std::vector<Clause> clauses;
    int channel;  // -1: a step of its own
    bool sends;
    std::vector<Test> assign;
    std::vector<int> resets;
    bool controllable;
};

struct Automaton {
    std::vector<std::vector<Bound>> invariants;  // per location
    int initial;
    std::vector<Edge> edges;
};

enum class Kind { reach, safety, reach_while_safe };

struct Place {
    int automaton = -1, location = -1;
};

struct Game {
    Kind kind;
    int clocks;
    raw_t delta;
    std::vector<raw_t> max;  // per clock, index 0 unused
    std::vector<int> variables;
    std::vector<Automaton> automata;
    Place goal, bad;
};

// A discrete state: a location per automaton, then a value per variable.
using Discrete = std::vector<int>;

inline bool at(const Discrete& d, const Place& p) { return p.automaton >= 0 && d[p.automaton] == p.location; }

inline bool holds(const Game& game, const Discrete& d, const std::vector<Clause>& clauses) {
    const int base = static_cast<int>(game.automata.size());
    for (const auto& clause : clauses) {
        bool any = false;
        for (const auto& test : clause) any = any || d[base + test.variable] == test.value;
        if (!any) return false;
    }
    return true;
}

struct Move {
    std::vector<int> edges;  // ids, sender first
    int owner;               // automaton of the sender
    bool controllable;
    std::vector<Bound> guard;
    std::vector<int> resets;
    Discrete target;
};

// All joint moves of a discrete state: a sender (or an own step), and of every other automaton with enabled receiving
// edges one of them. Guards read the state before; assignments run sender first, then receivers in system order.
inline std::vector<Move> joint_moves(const Game& game, const Discrete& d) {
    std::vector<Move> moves;
    const int count = static_cast<int>(game.automata.size());
    for (int a = 0; a < count; ++a)
        for (const Edge& sender : game.automata[a].edges) {
            if (sender.source != d[a] || (sender.channel >= 0 && !sender.sends) || !holds(game, d, sender.clauses)) continue;
            std::vector<std::vector<std::pair<int, const Edge*>>> combinations{{{a, &sender}}};
            for (int b = 0; sender.channel >= 0 && b < count; ++b) {
                if (b == a) continue;
                std::vector<const Edge*> receivers;
                for (const Edge& edge : game.automata[b].edges)
                    if (edge.channel == sender.channel && !edge.sends && edge.source == d[b] && holds(game, d, edge.clauses))
                        receivers.push_back(&edge);
                if (receivers.empty()) continue;
                decltype(combinations) longer;
                for (const auto& partial : combinations)
                    for (const Edge* edge : receivers) {
                        longer.push_back(partial);
                        longer.back().emplace_back(b, edge);
                    }
                combinations.swap(longer);
            }
            for (const auto& parts : combinations) {
                Move move{{}, a, true, sender.guard, {}, d};
                for (const auto& [automaton, edge] : parts) {
                    move.edges.push_back(edge->id);
                    move.controllable = move.controllable && edge->controllable;
                    move.resets.insert(move.resets.end(), edge->resets.begin(), edge->resets.end());
                    move.target[automaton] = edge->target;
                    for (const auto& set : edge->assign) move.target[count + set.variable] = set.value;
                }
                moves.push_back(std::move(move));
            }
        }
    return moves;
}

}  // namespace pursue
