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

// For each automaton, location and clock the largest constant that the automaton may compare the clock with before it
// resets it, -1: none (Behrmann et al. 2003). Clocks that no automaton asks for do not matter in a discrete state.
class Horizon {
  public:
    explicit Horizon(const Game& game) : clocks_(game.clocks) {
        for (const auto& automaton : game.automata) {
            auto& table = largest_.emplace_back(automaton.invariants.size(), std::vector<raw_t>(clocks_ + 1, -1));
            const auto note = [&](int location, const std::vector<Bound>& bounds) {
                for (const Bound& b : bounds) {
                    raw_t& largest = table[location][b.i ? b.i : b.j];
                    largest = std::max(largest, b.i ? b.raw >> 1 : -(b.raw >> 1));
                }
            };
            for (std::size_t l = 0; l < automaton.invariants.size(); ++l) note(static_cast<int>(l), automaton.invariants[l]);
            for (const Edge& edge : automaton.edges) note(edge.source, edge.guard);
            for (bool changed = true; changed;) {
                changed = false;
                for (const Edge& edge : automaton.edges)
                    for (int x = 1; x <= clocks_; ++x) {
                        if (std::find(edge.resets.begin(), edge.resets.end(), x) != edge.resets.end()) continue;
                        if (table[edge.target][x] <= table[edge.source][x]) continue;
                        table[edge.source][x] = table[edge.target][x];
                        changed = true;
                    }
            }
        }
    }

    // Per clock (index 0 unused) for a discrete state, padded with -1 to `size`.
    std::vector<raw_t> at(const Discrete& d, int size) const {
        std::vector<raw_t> out(size, -1);
        for (std::size_t a = 0; a < largest_.size(); ++a)
            for (int x = 1; x <= clocks_; ++x) out[x] = std::max(out[x], largest_[a][d[a]][x]);
        return out;
    }

  private:
    int clocks_;
    std::vector<std::vector<std::vector<raw_t>>> largest_;
};

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
