// Network and strategy as integer tables, as pursue_gen/proof/native/tables.py makes them.
//
// Constants are those of the network's and the strategy's common scale; a search multiplies them by a factor of its own.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace pursue::proof {

// `x_i - x_j` within the raw bound.
struct Bound {
    int i, j;
    std::int64_t raw;
};

// The bound in time units that are `factor` times finer.
inline std::int64_t finer(std::int64_t raw, std::int64_t factor) { return 2 * factor * (raw >> 1) + (raw & 1); }

struct Test {
    int variable, value;
};

struct Edge {
    int kind;  // edges of one kind cannot be told apart: the number of the first of them
    int source, target;
    std::vector<Bound> guard;
    std::vector<std::vector<Test>> clauses;  // of each clause any test
    int channel;                             // -1: a step of its own
    bool sends;                              // true for a step of its own as well
    std::vector<Test> assign;
    std::vector<int> resets;
    bool controllable;
};

struct Automaton {
    std::vector<std::vector<Bound>> invariants;  // of each location
    std::vector<std::vector<int>> leaving;       // of each location the edges that leave it, by their numbers
};

// A discrete state: a location of each automaton, then a value of each variable.
using Discrete = std::vector<std::int32_t>;

struct HashOfState {
    std::size_t operator()(const Discrete& state) const {
        std::size_t hash = 14695981039346656037u;
        for (std::int32_t number : state) hash = (hash ^ static_cast<std::uint32_t>(number)) * 1099511628211u;
        return hash;
    }
};

struct Network {
    int dim;  // clocks plus one
    std::vector<Automaton> automata;
    std::vector<Edge> edges;
    Discrete initial;
};

// A zone of a strategy: numbers of constraints. Zones are numbered through the strategy, in the order of its blocks: those
// to wait in first, then those of each command.
using ZoneTable = std::vector<int>;

struct CommandTable {
    std::vector<int> move;  // kinds of edges, the sender's (or tau's) first; -1: not an edge of the network
    std::vector<ZoneTable> zones;
};

struct BlockTable {
    Discrete state;
    std::vector<ZoneTable> wait;
    std::vector<CommandTable> commands;
    int first;  // the number of its first zone
};

struct Strategy {
    std::vector<Bound> constraints;
    std::vector<BlockTable> blocks;
    std::unordered_map<Discrete, std::vector<int>, HashOfState> of_state;  // the blocks of a discrete state
};

struct Tables {
    Network network;
    Strategy strategy;
};

// How a strategy is played, see closed_loop.py; in scaled time units.
struct Rules {
    int reaction;
    bool prompt, must_end;
    int instant;
};

}  // namespace pursue::proof
