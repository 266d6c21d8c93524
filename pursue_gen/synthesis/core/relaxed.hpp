// Which controllable edge looks best: the first one of a relaxed plan (delete relaxation, as the FF planner has it).
//
// Facts are "automaton a is at location l" and "variable x has value v"; a step never takes a fact away. Uncontrollable
// edges count only where an invariant will force them (ends of movements and actions): nobody may hope for the rest.
#pragma once

#include <map>
#include <numeric>

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
                add_step(a, edge, -1, nullptr);
                if (edge.channel < 0) continue;
                for (int b = 0; b < static_cast<int>(game.automata.size()); ++b)
                    for (const Edge& other : game.automata[b].edges)
                        if (b != a && other.channel == edge.channel && !other.sends) add_step(a, edge, b, &other);
            }
    }

    struct Plan {
        std::vector<int> first[2];  // sender edges that it takes first: uncontrollable ones, controllable ones
        bool acts[2] = {false, false};  // whether there are such steps at all, now or later
        std::vector<int> uses;          // the automata and (behind them) variables on whose state it builds
    };

    // A relaxed plan from d to a place; an empty one where there is none.
    Plan plan(const Discrete& d, Place to) const {
        std::vector<int> layer(facts_.size(), -1), achiever(facts_.size(), -1);
        for (std::size_t k = 0; k < d.size(); ++k) {
            const auto fact = facts_.find({static_cast<int>(k), d[k]});
            if (fact != facts_.end()) layer[fact->second] = 0;
        }
        const auto goal = facts_.find({to.automaton, to.location});
        if (goal == facts_.end()) return {};
        std::vector<int> open(steps_.size());
        std::iota(open.begin(), open.end(), 0);
        for (int depth = 0; layer[goal->second] < 0; ++depth) {
            bool changed = false;
            std::vector<std::pair<int, int>> reached;
            const auto taken = [&](int s) {
                if (!ready(steps_[s], layer)) return false;
                for (int fact : steps_[s].effects)
                    if (layer[fact] < 0) reached.emplace_back(fact, s);
                return true;
            };
            open.erase(std::remove_if(open.begin(), open.end(), taken), open.end());
            for (const auto& [fact, step] : reached)
                if (layer[fact] < 0) {
                    layer[fact] = depth + 1;
                    achiever[fact] = step;
                    changed = true;
                }
            if (!changed) return {};
        }
        return extract(goal->second, layer, achiever);
    }

  private:
    struct Step {
        int edge;
        bool controllable;
        std::vector<std::vector<int>> needs;  // of each at least one fact
        std::vector<int> effects;
    };

    int fact(int what, int value) {
        const auto [it, fresh] = facts_.emplace(std::make_pair(what, value), static_cast<int>(facts_.size()));
        if (fresh) what_.push_back(what);
        return it->second;
    }

    void add_part(Step& step, int automaton, const Edge& edge) {
        const int base = static_cast<int>(game_.automata.size());
        step.needs.push_back({fact(automaton, edge.source)});
        for (const auto& clause : edge.clauses) {
            std::vector<int> any;
            for (const auto& test : clause) any.push_back(fact(base + test.variable, test.value));
            step.needs.push_back(any);
        }
        step.effects.push_back(fact(automaton, edge.target));
        if (automaton == game_.bad.automaton && edge.source != edge.target) {
            const int rest = game_.automata[automaton].initial;
            if (edge.target == rest) step.effects.push_back(fact(DUTY_DONE.automaton, DUTY_DONE.location));
            if (edge.source == rest) step.effects.push_back(fact(DUTY_COME.automaton, DUTY_COME.location));
        }
        for (const auto& set : edge.assign) step.effects.push_back(fact(base + set.variable, set.value));
    }

    void add_step(int a, const Edge& sender, int b, const Edge* receiver) {
        Step step{sender.id, sender.controllable && (!receiver || receiver->controllable), {}, {}};
        add_part(step, a, sender);
        if (receiver) add_part(step, b, *receiver);
        steps_.push_back(std::move(step));
    }

    static bool ready(const Step& step, const std::vector<int>& layer) {
        for (const auto& any : step.needs) {
            bool found = false;
            for (int fact : any) found = found || layer[fact] >= 0;
            if (!found) return false;
        }
        return true;
    }

    Plan extract(int goal, const std::vector<int>& layer, const std::vector<int>& achiever) const {
        Plan plan;
        std::vector<int> open{goal};
        std::vector<bool> seen(facts_.size(), false);
        while (!open.empty()) {
            const int fact = open.back();
            open.pop_back();
            if (seen[fact]) continue;
            seen[fact] = true;
            if (what_[fact] >= 0) plan.uses.push_back(what_[fact]);
            if (layer[fact] == 0) continue;
            const Step& step = steps_[achiever[fact]];
            plan.acts[step.controllable] = true;
            bool now = true;
            for (const auto& any : step.needs) {
                int best = -1;
                for (int need : any)
                    if (layer[need] >= 0 && (best < 0 || layer[need] < layer[best])) best = need;
                now = now && layer[best] == 0;
                open.push_back(best);
            }
            auto& first = plan.first[step.controllable];
            if (now && std::find(first.begin(), first.end(), step.edge) == first.end()) first.push_back(step.edge);
        }
        return plan;
    }

    const Game& game_;
    std::map<std::pair<int, int>, int> facts_;  // by what (an automaton, or a variable behind them) and its value
    std::vector<int> what_;                     // per fact
    std::vector<Step> steps_;
};

}  // namespace pursue
