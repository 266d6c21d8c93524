// A policy for several duties: who does which one next, and which commands come of it.
#pragma once

#include "duties.hpp"

namespace pursue {

// Which duty is next for a robot.
enum class Next { in_turn, soonest_due, nearest };

// What a robot does that owes nothing: it stays, goes back to where it began, or to its post.
enum class Idle { stays, goes_home, goes_to_post };

struct Guess {
    Next next = Next::in_turn;
    bool shared_out = true;  // each duty is one robot's: who has least to do
    Idle idle = Idle::stays;
    std::size_t zones = 1;   // more zones of one state become one, which only adds plays
    bool apart = true;       // but only those that the same agent's moves lead to: then its pause has just begun
    bool by_time = false;    // duties are shared out by how long they take; who has more to do has the right of way
};

class Dispatch {
  public:
    // `joints`: of the game; what is decided are their numbers.
    Dispatch(const Game& game, Joints& joints, const Guess& guess) : game_(game), joints_(joints), guess_(guess), duties_(game) {
        if (guess.shared_out && robots() > 1) share_out();
        for (const int robot : duties_.robots())
            homes_.push_back(guess.idle == Idle::goes_home ? duties_.at_location(robot, game.automata[robot].initial) : -1);
        if (guess.idle == Idle::goes_to_post) find_posts();
    }

    std::size_t robots() const { return duties_.robots().size(); }

    // Whether a move from d does the duty of an automaton, or begins it anew.
    bool touches(const Discrete& d, const Joint& joint, int duty) const { return duties_.touches(d, joint, duty); }

    // Which duty each robot is at after a move to d; before, it was at those of `last`. Those just done are -1 in `memory`.
    void remember(const Discrete& d, std::vector<int>& memory, const std::vector<int>& last = {}) {
        for (int& duty : memory)
            if (duty >= 0 && (guess_.next == Next::soonest_due || !duties_.is_open(d, duty))) duty = -1;
        for (;;) {
            std::tuple<std::int64_t, std::size_t, int> best{Duties::NEVER, 0, -1};
            for (std::size_t r = 0; r < memory.size(); ++r)
                if (memory[r] < 0) best = std::min(best, next_duty(d, r, memory, last.empty() ? -1 : last[r]));
            const auto [place, robot, duty] = best;
            if (duty < 0) return;
            memory[robot] = duty;
        }
    }

    // The commands in d, at most one for each robot.
    std::vector<int> decided(const Discrete& d, const std::vector<int>& enabled, const std::vector<int>& memory) {
        const std::vector<int>& robots = duties_.robots();
        std::vector<int> wanted;
        std::vector<std::set<int>> ways;
        for (std::size_t r = 0; r < robots.size(); ++r)
            wanted.push_back(wants(d, enabled, r, memory[r], ways.emplace_back()));
        std::vector<int> commands = wanted;
        for (std::size_t q = 0; q < robots.size(); ++q)
            for (std::size_t r = 0; r < robots.size() && wanted[q] >= 0; ++r) {
                if (r == q || !ways[q].count(d[robots[r]]) || !leads_to_loss(together(d, robots[q], robots[r]))) continue;
                const bool blocked = ways[r].count(d[robots[q]]) && leads_to_loss(together(d, robots[r], robots[q]));
                if (wanted[r] >= 0 && (r < q || !blocked)) continue;  // it goes on by itself, or first
                std::set<int> out;
                commands[r] = makes_way(d, enabled, robots[r], d[robots[q]], ways[q], out);
                if (commands[r] >= 0 && out.count(ended(joints_[wanted[q]].target(d), robots[q])[robots[q]])) commands[q] = -1;
            }
        for (std::size_t q = 0; q < load_.size() && guess_.by_time; ++q)
            if (commands[q] == wanted[q] && wanted[q] >= 0 && is_in_the_way(d, q, wanted[q], memory, ways[q])) commands[q] = -1;
        // Who can leave only when somebody else is there is relieved by one who has nothing to do.
        for (std::size_t q = 0; q < robots.size(); ++q)
            for (std::size_t r = 0; r < robots.size() && commands[q] >= 0; ++r) {
                if (wanted[r] >= 0 || commands[r] >= 0 || !leads_to_loss(joints_[commands[q]].target(d))) continue;
                if (leads_to_loss(joints_[commands[q]].target(together(d, robots[r], robots[q])))) continue;
                commands[r] = towards(d, enabled, robots[r], d[robots[q]]);
            }
        const auto fails = [&](int j) { return j < 0 || leads_to_loss(joints_[j].target(d)); };
        commands.erase(std::remove_if(commands.begin(), commands.end(), fails), commands.end());
        return commands;
    }

  private:
    static constexpr std::size_t BOUNDS_OF_A_STATE = 1024;  // a look at one takes about as long as at so many bounds
    static constexpr int STEPS_AHEAD = 16;                  // so many commands of another robot are looked at

    // Gives each duty to one of the robots that can do it: those that few can do first, then perhaps what takes longest.
    void share_out() {
        const std::size_t robots = duties_.robots().size();
        std::vector<std::tuple<std::vector<std::size_t>, std::int64_t, int>> able;  // who, its time, the duty
        for (const int a : duties_.watching()) {
            std::vector<std::size_t> who;
            std::int64_t time = 0;
            for (std::size_t r = 0; r < robots; ++r)
                if (duties_.can(duties_.robots()[r], a)) {
                    who.push_back(r);
                    time = guess_.by_time ? std::max(time, time_for(duties_.robots()[r], a)) : 1;
                }
            if (!who.empty()) able.emplace_back(std::move(who), time, a);
        }
        std::stable_sort(able.begin(), able.end(), [](const auto& x, const auto& y) {
            return std::pair(std::get<0>(x).size(), -std::get<1>(x)) < std::pair(std::get<0>(y).size(), -std::get<1>(y));
        });
        load_.assign(robots, 0);
        for (const auto& [who, time, a] : able) {
            const std::size_t least = *std::min_element(who.begin(), who.end(), [&](auto x, auto y) { return load_[x] < load_[y]; });
            load_[least] += time;
            of_[a] = least;
        }
    }

    // About how long a robot takes for the duty of automaton a from where it begins.
    std::int64_t time_for(int robot, int a) {
        Discrete d;
        for (const auto& automaton : game_.automata) d.push_back(automaton.initial);
        d.insert(d.end(), game_.variables.begin(), game_.variables.end());
        const auto& bounds = game_.automata[a].invariants;
        const auto open = std::find_if(bounds.begin(), bounds.end(), [](const auto& some) { return !some.empty(); });
        if (open != bounds.end()) d[a] = static_cast<int>(open - bounds.begin());
        duties_.look(d, robot);
        const std::int64_t cost = duties_.cost(duties_.done(a));
        return cost == Duties::NEVER ? 0 : cost;
    }

    // The next duty for a robot after its last one that no robot is at, behind a number: less is better.
    std::tuple<std::int64_t, std::size_t, int> next_duty(const Discrete& d, std::size_t robot, const std::vector<int>& memory,
                                                         int last) {
        std::tuple<std::int64_t, std::size_t, int> best{Duties::NEVER, robot, -1};
        bool looked = false;
        for (const int a : duties_.watching()) {
            if (!duties_.is_open(d, a) || std::find(memory.begin(), memory.end(), a) != memory.end()) continue;
            if (!looked) duties_.look(d, duties_.robots()[robot]);
            looked = true;
            const std::int64_t cost = duties_.cost(duties_.done(a));
            const auto whose = of_.find(a);
            if (cost == Duties::NEVER || (whose != of_.end() && whose->second != robot)) continue;
            std::int64_t place = a > last ? a : a + static_cast<int>(game_.automata.size());
            if (guess_.next == Next::soonest_due) place = duties_.deadline(d, a);
            if (guess_.next == Next::nearest) place = cost;
            best = std::min(best, {place, robot, a});
        }
        return best;
    }

    // The state with one robot where another one is.
    Discrete together(const Discrete& d, int robot, int other) const { return placed(d, robot, d[other]); }

    // The state with a robot at a location.
    Discrete placed(Discrete d, int robot, int location) const {
        d[robot] = location;
        for (const Edge& edge : game_.automata[robot].edges)
            if (edge.target == location)
                for (const auto& set : edge.assign) d[game_.automata.size() + set.variable] = set.value;
        return d;
    }

    // A robot's post is where it has to be lest something happen that has no deadline; else the place from which the worst
    // of its duties takes the least part of its time.
    void find_posts() {
        const Discrete start = initial(game_);
        for (const int a : duties_.watching()) {
            std::int64_t least = Duties::NEVER;
            std::size_t who = robots();
            int post = -1;
            for (const auto& [r, location] : required(start, a)) {
                const int fact = duties_.at_location(duties_.robots()[r], location);
                duties_.look(start, duties_.robots()[r]);
                if ((homes_[r] >= 0 && homes_[r] != fact) || duties_.cost(fact) >= least) continue;
                std::tie(least, who, post) = std::tuple(duties_.cost(fact), r, fact);
            }
            if (who < robots()) homes_[who] = post;
        }
        for (std::size_t r = 0; r < robots(); ++r)
            if (homes_[r] < 0) homes_[r] = in_the_middle(start, r);
    }

    // The robots that keep automaton a from what is to be avoided by being at a location, and only there.
    std::vector<std::pair<std::size_t, int>> required(const Discrete& start, int a) const {
        std::vector<std::pair<std::size_t, int>> out;
        for (const Edge& edge : game_.automata[a].edges)
            for (std::size_t r = 0; r < robots() && duties_.is_loss(a, edge) && !is_timed(a, edge.source); ++r) {
                const int robot = duties_.robots()[r];
                std::vector<int> places;
                for (const int location : rests(robot))
                    if (prevents(placed(start, robot, location), robot, edge)) places.push_back(location);
                if (places.size() == 1) out.emplace_back(r, places.front());
            }
        return out;
    }

    // Whether an edge cannot be taken because of what a robot is at, whatever the others do.
    bool prevents(const Discrete& d, int robot, const Edge& edge) const {
        const auto& own = game_.automata[robot].edges;
        const auto is_own = [&](const Test& test) {
            return std::any_of(own.begin(), own.end(), [&](const Edge& e) {
                return std::any_of(e.assign.begin(), e.assign.end(), [&](const Test& set) { return set.variable == test.variable; });
            });
        };
        const auto holds = [&](const Test& test) { return d[game_.automata.size() + test.variable] == test.value; };
        return std::any_of(edge.clauses.begin(), edge.clauses.end(), [&](const auto& clause) {
            return std::all_of(clause.begin(), clause.end(), is_own) && std::none_of(clause.begin(), clause.end(), holds);
        });
    }

    // The location from which the worst of a robot's duties takes the least part of its time, -1: it has none.
    int in_the_middle(const Discrete& start, std::size_t r) {
        const int robot = duties_.robots()[r];
        double best = std::numeric_limits<double>::infinity();
        int middle = -1;
        for (const int location : rests(robot)) {
            double worst = -1;
            for (const int a : duties_.watching()) {
                const auto whose = of_.find(a);
                if (!duties_.can(robot, a) || (whose != of_.end() && whose->second != r)) continue;
                Discrete d = placed(start, robot, location);
                worst = std::max(worst, 0.0);
                for (const Edge& edge : game_.automata[a].edges) {
                    if (is_timed(a, edge.source) || !is_timed(a, edge.target) || prevents(d, robot, edge)) continue;
                    attend(BOUNDS_OF_A_STATE);
                    d[a] = edge.target;
                    duties_.look(d, robot);
                    worst = std::max(worst, static_cast<double>(duties_.cost(duties_.done(a))) / duties_.deadline(d, a));
                }
            }
            if (worst < 0 || worst >= best) continue;
            best = worst;
            middle = duties_.at_location(robot, location);
        }
        return middle;
    }

    bool is_timed(int a, int location) const { return !game_.automata[a].invariants[location].empty(); }

    // Where a robot may stay.
    std::vector<int> rests(int robot) const {
        std::vector<int> out;
        for (int location = 0; location < static_cast<int>(game_.automata[robot].invariants.size()); ++location)
            if (!is_timed(robot, location)) out.push_back(location);
        return out;
    }

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

    // Whether a command takes robot q to where one that has more to do may want to be before q has left again. `way`: q's.
    bool is_in_the_way(const Discrete& d, std::size_t q, int command, const std::vector<int>& memory, const std::set<int>& way) {
        const int robot = duties_.robots()[q];
        const Discrete there = ended(joints_[command].target(d), robot);
        duties_.look(d, robot);
        const auto cost = [&](int location) { return duties_.cost(duties_.at_location(robot, location)); };
        const std::int64_t arrival = cost(there[robot]);
        std::int64_t left = Duties::NEVER;
        for (const int location : way)
            if (cost(location) > arrival) left = std::min(left, cost(location));
        for (std::size_t r = 0; r < load_.size(); ++r)
            if (std::pair(load_[r], q) > std::pair(load_[q], r) && memory[r] >= 0 && comes(d, r, memory[r], there, robot, left))
                return true;
        return false;
    }

    // Whether robot r, on its way to a duty, may come within that time to where it must not be with another, who is at its
    // place in `there`. False where it does not come past the place at which the other one is in d.
    bool comes(const Discrete& d, std::size_t r, int duty, const Discrete& there, int other, std::int64_t within) {
        const int robot = duties_.robots()[r];
        if (leads_to_loss(together(d, robot, other))) return false;
        Discrete now = ended(d, robot);  // it may be there at once
        std::vector<int> enabled;
        std::int64_t time = 0;
        for (int step = 0; step < STEPS_AHEAD && time < within; ++step) {
            if (leads_to_loss(placed(there, robot, now[robot]))) return true;
            std::set<int> way;
            joints_.enabled(now, enabled);
            const int next = wants(now, enabled, r, duty, way);
            if (next < 0) return false;
            duties_.look(now, robot);
            now = ended(joints_[next].target(now), robot);
            const std::int64_t cost = duties_.cost(duties_.at_location(robot, now[robot]));
            if (cost == Duties::NEVER) return false;
            time += cost + 1;
        }
        return false;
    }

    // What robot r does next for a duty, -1: nothing; `way`: the locations that it passes then.
    int wants(const Discrete& d, const std::vector<int>& enabled, std::size_t r, int duty, std::set<int>& way) {
        const int fact = duty >= 0 ? duties_.done(duty) : homes_[r], robot = duties_.robots()[r];
        if (fact < 0) return -1;
        duties_.look(d, robot);
        if (duties_.cost(fact) == Duties::NEVER || duties_.cost(fact) == 0) return -1;
        way = duties_.way(fact, robot);
        return command(d, enabled, robot, duties_.first(fact));
    }

    // A command for a robot that stands in the way of another: to the nearest place out of it that it comes to without
    // passing the other, -1: there is none. `out`: the locations that it passes.
    int makes_way(const Discrete& d, const std::vector<int>& enabled, int robot, int other, const std::set<int>& way,
                  std::set<int>& out) {
        duties_.look(d, robot, other);
        std::int64_t least = Duties::NEVER;
        int nearest = -1;
        for (int place = 0; place < static_cast<int>(game_.automata[robot].invariants.size()); ++place) {
            const int fact = duties_.at_location(robot, place);
            if (way.count(place) || !game_.automata[robot].invariants[place].empty() || duties_.cost(fact) >= least) continue;
            least = duties_.cost(fact);
            nearest = fact;
        }
        if (nearest < 0) return -1;
        out = duties_.way(nearest, robot);
        return command(d, enabled, robot, duties_.first(nearest));
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

    // Whether the ends of what is under way, in some order, come to what is to be avoided.
    bool leads_to_loss(const Discrete& from) {
        std::set<Discrete> met{from};
        std::vector<Discrete> open{from};
        std::vector<int> enabled;
        while (!open.empty() && met.size() < 256) {
            const Discrete d = open.back();
            open.pop_back();
            attend(BOUNDS_OF_A_STATE);
            if (at_bad(game_, d)) return true;
            joints_.enabled(d, enabled);
            for (const int j : enabled) {
                const Joint& joint = joints_[j];
                if (joint.controllable) continue;
                if (!watches(game_, joint.owner) && game_.automata[joint.owner].invariants[d[joint.owner]].empty()) continue;
                Discrete next = joint.target(d);
                if (met.insert(next).second) open.push_back(std::move(next));
            }
        }
        return false;
    }

    const Game& game_;
    Joints& joints_;
    const Guess guess_;
    Duties duties_;
    std::vector<std::int64_t> load_;  // per robot how long its duties take it, none: they are not shared out
    std::map<int, std::size_t> of_;  // whose duty it is, by automaton
    std::vector<int> homes_;         // by robot, the fact that it is where it goes when it owes nothing; -1: it stays
};

}  // namespace pursue
