// The tables of a game, as the Python side compiles them (pursue_gen/synthesis/game.py says what each field means).
#pragma once

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "zones/native/dbm.hpp"

namespace pursue {

struct Bound {
    int i, j;
    wide_t raw;
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
    bool heard;  // no move where it changes nothing but where its automaton is, and its clocks
    std::vector<Test> assign;
    std::vector<int> resets;
    bool controllable;
};

struct Automaton {
    std::vector<std::vector<Bound>> invariants;  // per location
    int initial, home;  // where it starts; where it is when nothing has begun
    std::vector<Edge> edges;
};

enum class Kind { reach, safety, reach_while_safe };

struct Place {
    int automaton = -1, location = -1;
};

struct Game {
    Kind kind;
    int clocks;
    wide_t delta;
    std::vector<int> variables;
    std::vector<Bound> start;  // of the clocks at the start; none: they are 0
    std::vector<Automaton> automata;
    std::vector<Place> goal, bad;  // all of the goal at once; any of what is bad
    std::vector<int> unseen, unseen_clocks;  // of a discrete state, and clocks: what cannot matter
};

// A discrete state: a location per automaton, then a value per variable.
using Discrete = std::vector<std::int32_t>;

// The state in which a game begins.
inline Discrete initial(const Game& game) {
    Discrete d;
    for (const auto& a : game.automata) d.push_back(a.initial);
    d.insert(d.end(), game.variables.begin(), game.variables.end());
    return d;
}

inline bool at(const Discrete& d, const Place& p) { return d[p.automaton] == p.location; }

inline bool at_goal(const Game& game, const Discrete& d) {
    return !game.goal.empty() &&
           std::all_of(game.goal.begin(), game.goal.end(), [&](const Place& p) { return at(d, p); });
}

inline bool at_bad(const Game& game, const Discrete& d) {
    return std::any_of(game.bad.begin(), game.bad.end(), [&](const Place& p) { return at(d, p); });
}

// Whether an automaton watches what is to be avoided: the duties of the controller are done where it is at its home.
inline bool watches(const Game& game, int automaton) {
    return std::any_of(game.bad.begin(), game.bad.end(), [&](const Place& p) { return p.automaton == automaton; });
}

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
// resets it, -1: none (Behrmann et al. 2003). Clocks that no automaton compares do not matter in a discrete state.
class MaxConstants {
  public:
    explicit MaxConstants(const Game& game) : clocks_(game.clocks) {
        for (const auto& automaton : game.automata) {
            auto& table = largest_.emplace_back(automaton.invariants.size(), std::vector<wide_t>(clocks_ + 1, -1));
            const auto note = [&](int location, const std::vector<Bound>& bounds) {
                for (const Bound& b : bounds) {
                    wide_t& largest = table[location][b.i ? b.i : b.j];
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
    std::vector<wide_t> at(const Discrete& d, int size) const {
        std::vector<wide_t> out(size, -1);
        for (std::size_t a = 0; a < largest_.size(); ++a)
            for (int x = 1; x <= clocks_; ++x) out[x] = std::max(out[x], largest_[a][d[a]][x]);
        return out;
    }

  private:
    int clocks_;
    std::vector<std::vector<std::vector<wide_t>>> largest_;
};

}  // namespace pursue
