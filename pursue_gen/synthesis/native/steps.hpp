// What a robot does next for a duty, and what comes of it.
#pragma once

#include "tasks.hpp"

namespace pursue {

class Steps {
  protected:
    static constexpr int STEPS_AHEAD = 16;  // so many commands of a robot are looked at

    // `joints`, `duties`: of the game; commands are numbers of joints.
    Steps(const Game& game, Joints& joints, Duties& duties, const Guess& guess)
        : game_(game), joints_(joints), guess_(guess), duties_(duties), tasks_(game, duties_, guess),
          count_(static_cast<int>(game.automata.size())) {}

    // What robot r does next for a duty, -1: nothing; `way`: the locations that it passes then.
    int wants(const Discrete& d, const std::vector<int>& enabled, std::size_t r, int duty, std::set<int>& way) {
        const int post = tasks_.guarded(r, d), robot = duties_.robots()[r];
        if (post < 0 && charges_first(d, r, duty)) return charges(d, enabled, robot, way);
        const int fact = post >= 0 ? post : duty >= 0 ? duties_.done(duty % count_) : tasks_.home(r);
        const bool prepares = fact < 0 && guess_.idle == Idle::prepares;
        if (fact < 0 && !prepares) return -1;
        const int next = prepares ? this->prepares(d, enabled, r, way) : begins(d, enabled, robot, fact, way);
        return next < 0 || can_charge(ended(joints_[next].target(d), robot), robot) ? next : charges(d, enabled, robot, way);
    }

    // The first command of a robot's plan to a fact, -1: none; `way`: the locations that it passes then.
    int begins(const Discrete& d, const std::vector<int>& enabled, int robot, int fact, std::set<int>& way) {
        duties_.look(d, robot);
        if (duties_.cost(fact) == Duties::NEVER || duties_.cost(fact) == 0) return -1;
        way = duties_.way(fact, robot);
        return command(d, enabled, robot, duties_.first(fact));
    }

    // The same for an action that has to come before one that robot r is not asked for yet.
    int prepares(const Discrete& d, const std::vector<int>& enabled, std::size_t r, std::set<int>& way) {
        const int robot = duties_.robots()[r];
        for (const int a : duties_.watching())
            for (const Edge& edge : game_.automata[a].edges) {
                if (!tasks_.is_for(r, a) || edge.source != d[a] || duties_.is_timed(a, d[a]) || !duties_.is_timed(a, edge.target))
                    continue;
                Discrete asked = d;
                asked[a] = edge.target;
                if (!needs_another(asked, robot, a)) continue;
                duties_.look(asked, robot);
                way = duties_.way(duties_.done(a), robot);
                return command(d, enabled, robot, duties_.first(duties_.done(a)));
            }
        return -1;
    }

    // Whether a robot does something at a place on its way to the duty of automaton a before it does the duty.
    bool needs_another(Discrete d, int robot, int a) {
        std::vector<int> enabled;
        std::set<int> way;
        for (int step = 0; step < STEPS_AHEAD; ++step) {
            joints_.enabled(d, enabled);
            const int next = begins(d, enabled, robot, duties_.done(a), way);
            if (next < 0) return false;
            const Discrete after = ended(joints_[next].target(d), robot);
            if (!duties_.is_open(after, a)) return false;
            if (after[robot] == d[robot]) return true;
            d = after;
        }
        return false;
    }

    // The same to where it charges next.
    int charges(const Discrete& d, const std::vector<int>& enabled, int robot, std::set<int>& way) {
        duties_.look(d, robot);
        std::pair<std::int64_t, int> nearest{Duties::NEVER, -1};
        for (const int location : duties_.charging(robot)) {
            const int fact = duties_.at_location(robot, location);
            nearest = std::min(nearest, {duties_.cost(fact), fact});
        }
        return nearest.first == Duties::NEVER ? -1 : begins(d, enabled, robot, nearest.second, way);
    }

    // Whether a robot that has a battery comes to where it charges, if it goes there at once.
    bool can_charge(Discrete d, int robot) {
        const std::set<int> charging = duties_.charging(robot);
        std::vector<int> enabled;
        std::set<int> way;
        for (int step = 0; step < STEPS_AHEAD && !charging.empty() && !charging.count(d[robot]); ++step) {
            joints_.enabled(d, enabled);
            const int next = charges(d, enabled, robot, way);
            if (next < 0) return false;
            d = joints_[next].target(d);
            if (!charging.count(d[robot])) d = ended(d, robot);
        }
        return charging.empty() || charging.count(d[robot]);
    }

    // Whether robot r charges before it sees to a duty: it has none, the battery does not last for it, or the robot is there.
    bool charges_first(const Discrete& d, std::size_t r, int duty) {
        const int robot = duties_.robots()[r];
        if (!duties_.has_less(d, robot, 100)) return false;
        if (duties_.is_at_charger(d, robot) && duties_.has_less(d, robot, guess_.charge)) return true;
        return duty < 0 || !is_affordable(d, r, duty % count_);
    }

    // Whether a robot that has a battery can do the duty of automaton a and come to where it charges then.
    bool is_affordable(Discrete d, std::size_t r, int a) {
        const int robot = duties_.robots()[r];
        std::vector<int> enabled;
        std::set<int> way;
        for (int step = 0; step < STEPS_AHEAD && duties_.is_open(d, a); ++step) {
            joints_.enabled(d, enabled);
            const int next = begins(d, enabled, robot, duties_.done(a), way);
            if (next < 0) return false;
            d = ended(joints_[next].target(d), robot);
        }
        return can_charge(d, robot);
    }

    // The state with one robot where another one is.
    Discrete together(const Discrete& d, int robot, int other) const { return duties_.placed(d, robot, d[other]); }

    // The first command on a robot's way to a location, -1: none.
    int towards(const Discrete& d, const std::vector<int>& enabled, int robot, int location) {
        duties_.look(d, robot);
        const int fact = duties_.at_location(robot, location);
        if (duties_.cost(fact) == Duties::NEVER || duties_.cost(fact) == 0) return -1;
        return command(d, enabled, robot, duties_.first(fact));
    }

    int command(const Discrete& d, const std::vector<int>& enabled, int robot, int edge) const {
        for (const int j : enabled)
            if (joints_[j].edges[0] == edge && joints_[j].controllable && joints_[j].owner == robot &&
                !joints_[j].changes_nothing(d, game_))
                return j;
        return -1;
    }

    // The state after the end of what a robot does.
    Discrete ended(Discrete d, int robot) {
        std::vector<int> enabled;
        for (int n = 0; n < 3 && !game_.automata[robot].invariants[d[robot]].empty(); ++n) {
            joints_.enabled(d, enabled);
            for (const int j : enabled)
                if (joints_[j].owner == robot && !joints_[j].controllable) {
                    d = joints_[j].target(d);
                    break;
                }
        }
        return d;
    }

    // Whether the ends of what is under way, in some order, come to what is to be avoided. All policies ask so of the same
    // states, with other duties at hand.
    bool leads_to_loss(const Discrete& from) {
        return duties_.losses().of(from, [&] { return ends_in_loss(from); });
    }

    bool ends_in_loss(const Discrete& from) {
        States met(from.size());
        std::vector<int> open{met.number(from)}, enabled;
        while (!open.empty() && met.size() < 256) {
            const Discrete d = met[open.back()];
            open.pop_back();
            attend(BOUNDS_OF_A_STATE);
            if (at_bad(game_, d)) return true;
            joints_.enabled(d, enabled);
            for (const int j : enabled) {
                const Joint& joint = joints_[j];
                if (joint.controllable) continue;
                if (!watches(game_, joint.owner) && game_.automata[joint.owner].invariants[d[joint.owner]].empty()) continue;
                const std::size_t known = met.size();
                const int next = met.number(joint.target(d));
                if (met.size() > known) open.push_back(next);
            }
        }
        return false;
    }

    const Game& game_;
    Joints& joints_;
    const Guess guess_;
    Duties& duties_;
    Tasks tasks_;
    const int count_;  // of automata
};

}  // namespace pursue
