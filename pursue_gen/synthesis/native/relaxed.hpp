// Which controllable edge to try first: the first one of a relaxed plan (delete relaxation, Hoffmann and Nebel 2001).
//
// Facts are "automaton a is at location l" and "variable x has value v"; an operator never takes a fact away.
// Uncontrollable edges count only where an invariant will force them (ends of movements and actions).
#pragma once

#include "game.hpp"

namespace pursue {

class RelaxedPlanner {
  public:
    // Safety: the fact that a duty has been done, as a place.
    static constexpr Place DUTY_DONE{-1, 0};
    // The fact that a duty has come.
    static constexpr Place DUTY_COME{-2, 0};

    // `optimistic`: every uncontrollable edge counts, as if the environment helped.
    explicit RelaxedPlanner(const Game& game, bool optimistic = false) : game_(game) {
        for (int a = 0; a < static_cast<int>(game.automata.size()); ++a)
            for (const Edge& edge : game.automata[a].edges) {
                if (edge.channel >= 0 && !edge.sends) continue;
                if (!optimistic && !edge.controllable && game.automata[a].invariants[edge.source].empty()) continue;
                add_operator(a, edge, -1, nullptr);
                if (edge.channel < 0) continue;
                for (int b = 0; b < static_cast<int>(game.automata.size()); ++b)
                    for (const Edge& other : game.automata[b].edges)
                        if (b != a && other.channel == edge.channel && !other.sends) add_operator(a, edge, b, &other);
            }
    }

    struct Plan {
        std::vector<int> first[2];  // sender edges that it takes first: uncontrollable ones, controllable ones
        bool acts[2] = {false, false};  // whether it takes such edges at all, now or later
        std::vector<int> uses;          // the automata and (behind them) variables on whose state it builds
    };

    // A relaxed plan from d to a place; an empty one where there is none.
    Plan plan(const Discrete& d, Place to) const { return plan(d, std::vector<Place>{to}); }

    // A relaxed plan from d to all of the places; its first edges are for the first of them that is not reached.
    Plan plan(const Discrete& d, const std::vector<Place>& to) const {
        std::vector<int> goals;
        for (const Place& place : to) goals.push_back(known(place.automaton, place.location));
        if (goals.empty() || std::find(goals.begin(), goals.end(), -1) != goals.end()) return {};
        std::reverse(goals.begin(), goals.end());  // what comes last is taken first
        ++looks_;
        layers_.resize(facts_.size());
        met_.resize(preconditions_.size(), 0);
        missed_.resize(missing_.size());
        std::vector<int> ready, fresh;
        for (std::size_t k = 0; k < d.size(); ++k) {
            const int fact = known(static_cast<int>(k), d[k]);
            if (fact < 0) continue;
            layers_[fact] = {looks_, 0, -1};
            fresh.push_back(fact);
        }
        const auto missed = [&] { return std::any_of(goals.begin(), goals.end(), [&](int g) { return layer(g) < 0; }); };
        for (int depth = 0; missed(); ++depth) {
            ready.clear();
            for (int fact : fresh)
                for (int need : met_by_[fact]) {
                    if (met_[need] == looks_) continue;
                    met_[need] = looks_;
                    const int op = preconditions_[need];
                    if (missed_[op].first != looks_) missed_[op] = {looks_, missing_[op]};
                    if (--missed_[op].second == 0) ready.push_back(op);
                }
            std::sort(ready.begin(), ready.end());
            fresh.clear();
            for (int op : ready)
                for (int fact : operators_[op].effects)
                    if (layer(fact) < 0) {
                        layers_[fact] = {looks_, depth + 1, op};
                        fresh.push_back(fact);
                    }
            if (fresh.empty()) return {};
        }
        return extract(std::move(goals));
    }

  private:
    struct Operator {
        int edge;
        bool controllable;
        std::vector<std::vector<int>> preconditions;  // of each at least one fact
        std::vector<int> effects;
    };

    int fact(int what, int value) {
        const int old = known(what, value);
        if (old >= 0) return old;
        const int number = static_cast<int>(facts_.size());
        if (what + FIRST >= static_cast<int>(values_.size())) values_.resize(what + FIRST + 1);
        values_[what + FIRST].emplace_back(value, number);
        facts_.push_back(what);
        met_by_.emplace_back();
        return number;
    }

    void add_part(Operator& op, int automaton, const Edge& edge) {
        const int base = static_cast<int>(game_.automata.size());
        op.preconditions.push_back({fact(automaton, edge.source)});
        for (const auto& clause : edge.clauses) {
            std::vector<int> any;
            for (const auto& test : clause) any.push_back(fact(base + test.variable, test.value));
            op.preconditions.push_back(any);
        }
        op.effects.push_back(fact(automaton, edge.target));
        if (edge.source != edge.target && watches(game_, automaton)) {
            const int rest = game_.automata[automaton].home;
            if (edge.target == rest) op.effects.push_back(fact(DUTY_DONE.automaton, DUTY_DONE.location));
            if (edge.source == rest) op.effects.push_back(fact(DUTY_COME.automaton, DUTY_COME.location));
        }
        for (const auto& set : edge.assign) op.effects.push_back(fact(base + set.variable, set.value));
    }

    void add_operator(int a, const Edge& sender, int b, const Edge* receiver) {
        Operator op{sender.id, sender.controllable && (!receiver || receiver->controllable), {}, {}};
        add_part(op, a, sender);
        if (receiver) add_part(op, b, *receiver);
        const int number = static_cast<int>(operators_.size());
        for (const auto& any : op.preconditions) {
            for (int fact : any) met_by_[fact].push_back(static_cast<int>(preconditions_.size()));
            preconditions_.push_back(number);
        }
        missing_.push_back(static_cast<int>(op.preconditions.size()));
        operators_.push_back(std::move(op));
    }

    // The number of a fact, -1: no operator has it.
    int known(int what, int value) const {
        if (what + FIRST >= static_cast<int>(values_.size())) return -1;
        for (const auto& [of, fact] : values_[what + FIRST])
            if (of == value) return fact;
        return -1;
    }

    // The layer of a fact in the present look for a plan, -1: not met.
    int layer(int fact) const { return layers_[fact].look == looks_ ? layers_[fact].depth : -1; }

    Plan extract(std::vector<int> open) const {
        Plan plan;
        while (!open.empty()) {
            const int fact = open.back();
            open.pop_back();
            if (layers_[fact].seen) continue;
            layers_[fact].seen = true;
            if (facts_[fact] >= 0) plan.uses.push_back(facts_[fact]);
            if (layer(fact) == 0) continue;
            const Operator& op = operators_[layers_[fact].achiever];
            plan.acts[op.controllable] = true;
            bool now = true;
            for (const auto& any : op.preconditions) {
                int best = -1;
                for (int need : any)
                    if (layer(need) >= 0 && (best < 0 || layer(need) < layer(best))) best = need;
                now = now && layer(best) == 0;
                open.push_back(best);
            }
            auto& first = plan.first[op.controllable];
            if (now && std::find(first.begin(), first.end(), op.edge) == first.end()) first.push_back(op.edge);
        }
        return plan;
    }

    const Game& game_;
    static constexpr int FIRST = 2;  // what is below 0: DUTY_DONE and DUTY_COME

    std::vector<int> facts_;                                // per fact what it is about: an automaton, or a variable behind them
    std::vector<std::vector<std::pair<int, int>>> values_;  // per what, from FIRST on: values and their facts
    std::vector<int> preconditions_;                        // per precondition the operator that has it
    std::vector<std::vector<int>> met_by_;                  // per fact the preconditions that it meets
    std::vector<int> missing_;                              // per operator how many preconditions it has
    std::vector<Operator> operators_;

    // What a look for a plan works with. It is kept: most looks meet a small part of it, and what has the number of an
    // earlier look counts as not met.
    struct Layer {
        int look = 0, depth = 0, achiever = -1;
        bool seen = false;
    };
    mutable int looks_ = 0;
    mutable std::vector<Layer> layers_;                 // per fact
    mutable std::vector<int> met_;                      // per precondition the look that met it
    mutable std::vector<std::pair<int, int>> missed_;   // per operator the look, and how many of its preconditions it misses
};

}  // namespace pursue
