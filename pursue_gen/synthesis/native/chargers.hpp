// Batteries by time: automata that watch whether a robot comes to its charger, and stays there until its battery is full.
#pragma once

#include <map>
#include <set>

#include "moves.hpp"

namespace pursue {

class Chargers {
  public:
    Chargers() = default;

    // `watching`: automata that watch what is to be avoided; `robots`: those that commands move.
    Chargers(const Game& game, const std::vector<int>& watching, const std::vector<int>& robots) {
        for (const int a : watching) find(game, a, robots);
    }

    bool none() const { return found_.empty(); }

    // Whether automaton a watches such a battery.
    bool watches(int a) const { return found_.count(a) > 0; }

    // The automaton of a robot's battery, -1: it has none.
    int battery_of(int robot) const {
        const auto own = [&](const auto& each) { return each.second.robot == robot; };
        const auto it = std::find_if(found_.begin(), found_.end(), own);
        return it == found_.end() ? -1 : it->first;
    }

    // The robot of a battery, and its location at the charger.
    int robot(int a) const { return found_.at(a).robot; }
    int place(int a) const { return found_.at(a).place; }

    // Whether the robot of automaton a is at the charger, and the battery not full yet.
    bool is_charging(int a, int location) const { return watches(a) && found_.at(a).charging.count(location) > 0; }

  private:
    // `charging`: what its automaton leaves by itself, as time passes.
    struct Charger {
        int robot, place;
        std::set<int> charging;
    };

    void find(const Game& game, int a, const std::vector<int>& robots) {
        const Automaton& automaton = game.automata[a];
        const auto is_loss = [&](const Edge& edge) {
            return std::any_of(game.bad.begin(), game.bad.end(), [&](const Place& p) { return p.automaton == a && p.location == edge.target; });
        };
        Charger charger{-1, -1, {}};
        for (const Edge& edge : automaton.edges)
            if (edge.channel < 0 && !edge.controllable && !automaton.invariants[edge.source].empty() && !is_loss(edge))
                charger.charging.insert(edge.source);
        for (const Edge& edge : automaton.edges) {
            if (edge.channel < 0 || edge.sends || charger.charging.count(edge.source) || !charger.charging.count(edge.target)) continue;
            for (const int robot : robots)
                for (const Edge& sent : game.automata[robot].edges)
                    if (sent.channel == edge.channel && sent.sends) std::tie(charger.robot, charger.place) = std::pair(robot, sent.target);
        }
        if (charger.robot >= 0) found_.emplace(a, charger);
    }

    std::map<int, Charger> found_;  // by the automaton that watches
};

}  // namespace pursue
