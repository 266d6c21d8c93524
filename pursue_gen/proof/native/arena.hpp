// Discrete states with their joint moves, worked out when they are asked for (as in proof/moves.py).
#pragma once

#include <algorithm>
#include <deque>
#include <limits>
#include <memory>
#include <stdexcept>

#include "proof/native/tables.hpp"
#include "proof/native/unions.hpp"

namespace pursue::proof {

// Edges that are taken together: the sender's (or tau's) first, then the receivers' in system order.
template <class Z>
struct JointMove {
    int owner;
    std::vector<int> edges;
    bool controllable;
    int target;               // the number of a discrete state
    std::vector<int> resets;  // without doubles
    bool possible;            // whether it is enabled at some point
    Z enabled;                // where; only if it is possible
};

// An upper bound of an invariant.
template <class R>
struct InvariantBound {
    int owner, clock;
    R raw;
};

// All about a discrete state that does not depend on the strategy.
template <class Z>
struct Situation {
    bool possible;  // whether the invariant holds at some point
    Z invariant;
    std::vector<InvariantBound<typename Z::raw_t>> bounds;
    bool strict;  // whether one of the bounds is
    std::vector<JointMove<Z>> moves;
};

template <class Z>
class Arena {
  public:
    using R = typename Z::raw_t;

    const int dim;

    // Requires: network.dim <= Z::size, factor >= 1. Throws std::overflow_error for constants that Z cannot hold.
    Arena(const Network& network, std::int64_t factor)
        : dim(network.dim), network_(network), factor_(factor) {
        assert(dim <= Z::size && factor >= 1);
    }

    // So large may a bound be that goes into the steps from one discrete state: all that these compute with it still fits,
    // as a bound of a zone is the sum of a way through the clocks at the few instants that a step compares.
    static constexpr R most = INF<R> / (16 * Z::size);

    // The constant in the arena's scale.
    R scaled(std::int64_t raw) const {
        if (raw >= 0 ? raw / 2 >= most / (2 * factor_) : -(raw / 2) >= most / (2 * factor_))
            throw std::overflow_error("the constants are too large");
        return static_cast<R>(finer(raw, factor_));
    }

    // Throws std::overflow_error where a bound of the zone is too large to go on with.
    void check_width(const Z& z) const {
        for (int i = 0; i < dim; ++i)
            for (int j = 0; j < dim; ++j)
                if (z.at(i, j) < INF<R> && (z.at(i, j) > most || z.at(i, j) < -most))
                    throw std::overflow_error("the times are too large");
    }

    // Ensures: the points of z within the bounds, and true; or false: none.
    bool take(Z& z, const std::vector<Bound>& bounds) const {
        for (const Bound& b : bounds)
            if (!constrain(z, b.i, b.j, scaled(b.raw))) return false;
        return true;
    }

    const Network& network() const { return network_; }
    const Discrete& state(int number) const { return states_[number]; }

    // The number of the discrete state.
    int number(const Discrete& state) {
        const auto [found, is_new] = numbers_.try_emplace(state, static_cast<int>(states_.size()));
        if (is_new) {
            states_.push_back(state);
            situations_.emplace_back();
        }
        return found->second;
    }

    // The invariant and the joint moves of a discrete state. The reference stays valid.
    const Situation<Z>& situation(int number) {
        if (!situations_[number]) {
            auto made = std::make_unique<Situation<Z>>(work_out(states_[number]));
            situations_[number] = std::move(made);
        }
        return *situations_[number];
    }

  private:
    bool integers_hold(const Edge& edge, const Discrete& state) const {
        const std::size_t first = network_.automata.size();
        return std::all_of(edge.clauses.begin(), edge.clauses.end(), [&](const auto& clause) {
            return std::any_of(clause.begin(), clause.end(),
                               [&](const Test& test) { return state[first + test.variable] == test.value; });
        });
    }

    template <class F>
    void each_bound(const Discrete& state, F take) const {
        for (std::size_t a = 0; a < network_.automata.size(); ++a)
            for (const Bound& b : network_.automata[a].invariants[state[a]])
                take(static_cast<int>(a), b.i, scaled(b.raw));
    }

    Situation<Z> work_out(const Discrete state) {
        Situation<Z> out;
        out.possible = true;
        out.strict = false;
        out.invariant = universe<Z>();
        each_bound(state, [&](int owner, int clock, R raw) {
            out.bounds.push_back({owner, clock, raw});
            out.strict |= !(raw & 1);
            out.possible = out.possible && constrain(out.invariant, clock, 0, raw);
        });
        for (std::size_t a = 0; a < network_.automata.size(); ++a)
            for (int k : network_.automata[a].leaving[state[a]]) {
                const Edge& edge = network_.edges[k];
                if (edge.sends && integers_hold(edge, state)) joint_moves(state, out, static_cast<int>(a), k);
            }
        return out;
    }

    // Appends a move for every way in which all others that can receive take part.
    void joint_moves(const Discrete& state, Situation<Z>& out, int owner, int sender) {
        std::vector<std::vector<std::pair<int, int>>> choices;  // (automaton, edge)
        const int channel = network_.edges[sender].channel;
        for (std::size_t a = 0; channel >= 0 && a < network_.automata.size(); ++a) {
            if (static_cast<int>(a) == owner) continue;
            std::vector<std::pair<int, int>> able;
            for (int k : network_.automata[a].leaving[state[a]]) {
                const Edge& edge = network_.edges[k];
                if (!edge.sends && edge.channel == channel && integers_hold(edge, state)) able.push_back({static_cast<int>(a), k});
            }
            if (!able.empty()) choices.push_back(std::move(able));
        }
        std::vector<std::size_t> chosen(choices.size(), 0);
        for (;;) {
            std::vector<std::pair<int, int>> parts{{owner, sender}};
            for (std::size_t c = 0; c < choices.size(); ++c) parts.push_back(choices[c][chosen[c]]);
            JointMove<Z> move = joint(state, out, owner, parts);
            // After a move that changes no location, variable or clock nothing has happened.
            const bool idle = move.resets.empty() && states_[move.target] == state;
            if (!idle) out.moves.push_back(std::move(move));
            std::size_t c = choices.size();
            while (c > 0 && ++chosen[c - 1] == choices[c - 1].size()) chosen[--c] = 0;
            if (c == 0) return;
        }
    }

    JointMove<Z> joint(const Discrete& state, const Situation<Z>& here, int owner,
                       const std::vector<std::pair<int, int>>& parts) {
        JointMove<Z> out;
        out.owner = owner;
        out.controllable = true;
        Discrete target = state;
        for (const auto& [automaton, k] : parts) {
            const Edge& edge = network_.edges[k];
            out.edges.push_back(k);
            out.controllable = out.controllable && edge.controllable;
            target[automaton] = edge.target;
            for (const Test& set : edge.assign) target[network_.automata.size() + set.variable] = set.value;
            for (int x : edge.resets)
                if (std::find(out.resets.begin(), out.resets.end(), x) == out.resets.end()) out.resets.push_back(x);
        }
        out.possible = here.possible;
        if (out.possible) {
            out.enabled = here.invariant;
            out.possible = take(out.enabled, network_.edges[parts[0].second].guard);
        }
        each_bound(target, [&](int, int clock, R raw) {
            const bool reset_there = std::find(out.resets.begin(), out.resets.end(), clock) != out.resets.end();
            if (!out.possible) return;
            out.possible = reset_there ? raw >= LE_ZERO : constrain(out.enabled, clock, 0, raw);
        });
        out.target = number(target);
        return out;
    }

    const Network& network_;
    const std::int64_t factor_;
    std::deque<Discrete> states_;
    std::deque<std::unique_ptr<Situation<Z>>> situations_;
    std::unordered_map<Discrete, int, HashOfState> numbers_;
};

}  // namespace pursue::proof
