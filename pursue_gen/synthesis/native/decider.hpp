// Which commands are given where, by what robots are at: what all policies for several duties have in common.
#pragma once

#include "steps.hpp"

namespace pursue {

// A command, and the lower bound on a clock from which on it is given (i == j: at once).
struct Order {
    int joint;
    Bound since{0, 0, 0};
};

class Decider : protected Steps {
  public:
    // `joints` and `duties`: of the game; what is decided are numbers of joints.
    Decider(const Game& game, Joints& joints, Duties& duties, const Guess& guess)
        : Steps(game, joints, duties, guess), patrols_(game.automata.size()) {
        for (const int a : guess.patrols) patrols_[a] = true;
    }
    Decider(const Decider&) = delete;
    Decider& operator=(const Decider&) = delete;
    virtual ~Decider() = default;

    std::size_t robots() const { return duties_.robots().size(); }
    bool is_patrol(int a) const { return patrols_[a]; }
    bool is_charging(int a, int location) const { return duties_.chargers().is_charging(a, location); }
    const Tasks& tasks() const { return tasks_; }
    virtual bool alternates() const { return false; }

    // Whether the policy is another than those without its rules.
    virtual bool applies() const { return true; }

    // What is remembered at first, in d. Its size is always the same.
    virtual std::vector<int> remembered(const Discrete& d) = 0;

    // The same after a joint move from d; before, it was `memory`.
    virtual void remember(const Discrete& d, const Joint& joint, std::vector<int>& memory) = 0;

    // The commands in d: of each robot one at most, since when one of some bounds holds.
    virtual std::vector<Order> decided(const Discrete& d, const std::vector<int>& enabled, const std::vector<int>& memory) = 0;

  protected:
    // From when on a robot goes round its patrols, `first` to begin with: when one of them has no more time than the way
    // there, those before it included, and the reserve.
    std::vector<Bound> due(const Discrete& d, std::size_t r, int first) {
        const int robot = duties_.robots()[r];
        std::vector<int> round, enabled;
        for (const int a : duties_.watching())
            if (tasks_.is_for(r, a) && is_patrol(a) && duties_.is_open(d, a)) round.push_back(a);
        std::rotate(round.begin(), std::find(round.begin(), round.end(), first), round.end());
        std::vector<Bound> out;
        Discrete now = d;
        std::int64_t time = 0;
        while (!round.empty()) {
            const int a = round.front();
            for (int step = 0; step < STEPS_AHEAD && duties_.is_open(now, a); ++step) {
                std::set<int> way;
                joints_.enabled(now, enabled);
                const int next = wants(now, enabled, r, a, way);
                if (next < 0) return out;
                duties_.look(now, robot);  // a robot with a battery has looked ahead
                now = ended(joints_[next].target(now), robot);
                time += duties_.cost(duties_.at_location(robot, now[robot])) % Duties::DETOUR + 1;
                round.erase(std::remove_if(round.begin() + 1, round.end(), [&](int b) { return !duties_.is_open(now, b); }), round.end());
            }
            if (duties_.is_open(now, a)) return out;
            const Bound& deadline = game_.automata[a].invariants[d[a]].front();
            const std::int64_t period = deadline.raw >> 1, latest = period - period * guess_.reserve / 100 - time;
            out.push_back({0, deadline.i, static_cast<wide_t>(2 * -std::max<std::int64_t>(latest, 0) + 1)});
            round.erase(round.begin());
        }
        return out;
    }

    std::vector<bool> patrols_;  // by automaton
};

}  // namespace pursue
