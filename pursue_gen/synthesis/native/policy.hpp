// Which moves a search follows first. A win against every move of the environment with a few of one's own is a win, and
// what is lost against a few moves of the environment is lost.
#pragma once

#include "moves.hpp"
#include "relaxed.hpp"

namespace pursue {

class Policy {
  public:
    explicit Policy(const Game& game) : game_(game), pessimistic_(game), optimistic_(game, true) {
        for (int a = 0; a < static_cast<int>(game.automata.size()); ++a)
            if (!watches(game, a) && game.automata[a].invariants.size() > 1 && only_receives(a)) {
                event_orders_.push_back(a);
                if (begun_by_controller(a)) controller_orders_.push_back(a);
            }
        const int count = static_cast<int>(game.automata.size());
        for (int a = 0; a < count; ++a)
            if (watches(game, a)) duties_done_.push_back({a, game.automata[a].home});
        changed_by_.resize(count + game.variables.size());
        for (int a = 0; a < count; ++a)
            for (const Edge& e : game.automata[a].edges) {
                if (e.controllable || (e.channel >= 0 && !e.sends)) continue;
                if (e.source != e.target) changed_by_[a].push_back(e.id);
                for (const auto& set : e.assign) changed_by_[count + set.variable].push_back(e.id);
            }
    }

    // Reach: the one controllable edge that a relaxed plan to the goal takes first, or none.
    std::vector<int> towards_goal(const Discrete& d) const {
        std::vector<int> first = pessimistic_.plan(d, game_.goal).first[true];
        if (first.size() > 1) first.resize(1);
        return first;
    }

    // Safety: what to do for the first subgoal to which the controller can contribute. First the duties, then to bring to
    // their beginnings the orders of events (rules) that were begun, then to have done another duty later.
    std::vector<int> towards_subgoals(const Discrete& d) const {
        std::vector<int> first;
        for (const Place& subgoal : subgoals(d)) {
            const auto plan = pessimistic_.plan(d, subgoal);
            append(first, plan.first[true]);
            if (plan.acts[true]) return first;
        }
        append(first, optimistic_.plan(d, RelaxedPlanner::DUTY_DONE).first[true]);
        return first;
    }

    // Safety: whether the controller follows a move at first, given the edges that it prefers.
    bool serves_subgoals(const Discrete& d, const Joint& joint, const std::vector<int>& preferred) const {
        if (ends(d, joint)) return true;
        if (std::find(preferred.begin(), preferred.end(), joint.edges[0]) == preferred.end()) return false;
        // One order of events at a time.
        const auto under_way = [&](int a) { return d[a] != game_.automata[a].home; };
        const Discrete target = joint.target(d);
        const auto begun = [&](int a) { return !under_way(a) && target[a] != d[a]; };
        return std::none_of(controller_orders_.begin(), controller_orders_.end(), under_way) ||
               std::none_of(controller_orders_.begin(), controller_orders_.end(), begun);
    }

    // Safety: what the environment does at first: what brings it nearer to the controller's loss or to one more duty,
    // and all that agents can do on whose state the controller's plans for its subgoals build.
    std::vector<int> towards_loss(const Discrete& d) const {
        std::vector<int> first;
        for (const Place& bad : game_.bad) append(first, optimistic_.plan(d, bad).first[false]);
        append(first, optimistic_.plan(d, RelaxedPlanner::DUTY_COME).first[false]);
        for (const Place& subgoal : subgoals(d))
            for (int what : optimistic_.plan(d, subgoal).uses) append(first, changed_by_[what]);
        return first;
    }

    // The end of something that an invariant bounds: it has to come some time.
    bool ends(const Discrete& d, const Joint& joint) const {
        return !watches(game_, joint.owner) && !game_.automata[joint.owner].invariants[d[joint.owner]].empty();
    }

    // Whether states in which an automaton is at such a location come after others. In a reach game the controller's
    // agents do not count: they would be won for one after the other, and not be under way together.
    bool is_deferred(int a, int location) const {
        if (watches(game_, a)) return false;
        const auto& edges = game_.automata[a].edges;
        return std::none_of(edges.begin(), edges.end(), [&](const Edge& e) {
            return e.controllable && (game_.kind != Kind::safety || e.source == location);
        });
    }

    // What the controller of a safety game prefers to do, best first.
    std::vector<int> preferred(const Discrete& d) const {
        std::vector<int> first;
        for (const Place& duty : duties_done_) append(first, pessimistic_.plan(d, duty).first[true]);
        return first;
    }

  private:
    std::vector<Place> subgoals(const Discrete& d) const {
        std::vector<Place> out;
        for (const Place& duty : duties_done_)
            if (!at(d, duty)) out.push_back(duty);
        for (int a : event_orders_)
            if (d[a] != game_.automata[a].home) out.push_back({a, game_.automata[a].home});
        return out;
    }

    static void append(std::vector<int>& a, const std::vector<int>& b) { a.insert(a.end(), b.begin(), b.end()); }

    bool only_receives(int a) const {
        const auto& edges = game_.automata[a].edges;
        return std::none_of(edges.begin(), edges.end(), [](const Edge& e) { return e.channel < 0 || e.sends; });
    }

    // Whether only the controller takes the automaton out of its home.
    bool begun_by_controller(int a) const {
        for (const Edge& e : game_.automata[a].edges)
            if (e.source == game_.automata[a].home && e.target != e.source)
                for (const Automaton& other : game_.automata)
                    for (const Edge& sender : other.edges)
                        if (sender.channel == e.channel && sender.sends && !sender.controllable) return false;
        return true;
    }

    const Game& game_;
    RelaxedPlanner pessimistic_, optimistic_;
    std::vector<Place> duties_done_;            // the homes of the automata that watch what is to be avoided
    std::vector<int> event_orders_;             // automata that only receive: they follow an order of events
    std::vector<int> controller_orders_;        // those of them that only the controller begins
    std::vector<std::vector<int>> changed_by_;  // the environment's sender edges that change an automaton or a variable
};

}  // namespace pursue
