// Which moves a search follows first. A win against every move of the environment with a few of one's own is a win, and
// what is lost against a few moves of the environment is lost.
#pragma once

#include "moves.hpp"
#include "relaxed.hpp"

namespace pursue {

class Policy {
  public:
    explicit Policy(const Game& game) : game_(game), sure_(game), hopeful_(game, true) {
        for (int a = 0; a < static_cast<int>(game.automata.size()); ++a)
            if (a != game.bad.automaton && game.automata[a].invariants.size() > 1 && only_listens(a)) {
                orders_.push_back(a);
                if (begun_by_controller(a)) errands_.push_back(a);
            }
        const int count = static_cast<int>(game.automata.size());
        touching_.resize(count + game.variables.size());
        for (int a = 0; a < count; ++a)
            for (const Edge& e : game.automata[a].edges) {
                if (e.controllable || (e.channel >= 0 && !e.sends)) continue;
                if (e.source != e.target) touching_[a].push_back(e.id);
                for (const auto& set : e.assign) touching_[count + set.variable].push_back(e.id);
            }
    }

    // Reach: the one controllable edge that a relaxed plan to the goal takes first, or none.
    std::vector<int> towards_goal(const Discrete& d) const {
        std::vector<int> first = sure_.plan(d, game_.goal).first[true];
        if (first.size() > 1) first.resize(1);
        return first;
    }

    // Safety: what to do about the first wish that the controller can do something about. First the duty, then to bring
    // to their beginnings the orders of events (rules) that were begun, then to have another duty behind one some day.
    std::vector<int> towards_rest(const Discrete& d) const {
        std::vector<int> first;
        for (const Place& wish : wishes(d)) {
            const auto plan = sure_.plan(d, wish);
            append(first, plan.first[true]);
            if (plan.acts[true]) return first;
        }
        append(first, hopeful_.plan(d, RelaxedPlanner::DUTY_DONE).first[true]);
        return first;
    }

    // Safety: whether the controller follows a move at first, given what it wishes.
    bool serves(const Discrete& d, const Joint& joint, const std::vector<int>& wished) const {
        if (ends(d, joint)) return true;
        if (std::find(wished.begin(), wished.end(), joint.edges[0]) == wished.end()) return false;
        // One errand at a time.
        const auto under_way = [&](int a) { return d[a] != game_.automata[a].home; };
        const Discrete target = joint.target(d);
        const auto begun = [&](int a) { return !under_way(a) && target[a] != d[a]; };
        return std::none_of(errands_.begin(), errands_.end(), under_way) ||
               std::none_of(errands_.begin(), errands_.end(), begun);
    }

    // Safety: what the environment does at first: what brings it nearer to the controller's loss or to one more duty, and
    // all that agents can do on whose state the controller's wishes build.
    std::vector<int> towards_loss(const Discrete& d) const {
        std::vector<int> first = hopeful_.plan(d, game_.bad).first[false];
        append(first, hopeful_.plan(d, RelaxedPlanner::DUTY_COME).first[false]);
        for (const Place& wish : wishes(d))
            for (int what : hopeful_.plan(d, wish).uses) append(first, touching_[what]);
        return first;
    }

    // The end of something that an invariant bounds: it has to come some time.
    bool ends(const Discrete& d, const Joint& joint) const {
        return joint.owner != game_.bad.automaton && !game_.automata[joint.owner].invariants[d[joint.owner]].empty();
    }

    // Whether states in which an automaton is at such a location come after others. In a reach game the controller's
    // agents do not count: they would be won for one after the other, and not be under way together.
    bool comes_late(int a, int location) const {
        if (a == game_.bad.automaton) return false;
        const auto& edges = game_.automata[a].edges;
        return std::none_of(edges.begin(), edges.end(), [&](const Edge& e) {
            return e.controllable && (game_.kind != Kind::safety || e.source == location);
        });
    }

    // What the controller of a safety game likes to do, best first.
    std::vector<int> liked(const Discrete& d) const { return sure_.plan(d, duty_done()).first[true]; }

  private:
    std::vector<Place> wishes(const Discrete& d) const {
        std::vector<Place> out;
        if (!at(d, duty_done())) out.push_back(duty_done());
        for (int a : orders_)
            if (d[a] != game_.automata[a].home) out.push_back({a, game_.automata[a].home});
        return out;
    }

    Place duty_done() const { return {game_.bad.automaton, game_.automata[game_.bad.automaton].home}; }

    static void append(std::vector<int>& a, const std::vector<int>& b) { a.insert(a.end(), b.begin(), b.end()); }

    bool only_listens(int a) const {
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
    RelaxedPlanner sure_, hopeful_;
    std::vector<int> orders_;   // automata that only listen, and count where one is in an order of events
    std::vector<std::vector<int>> touching_;  // the environment's sender edges that change an automaton or a variable
    std::vector<int> errands_;  // those that only the controller begins
};

}  // namespace pursue
