// A policy for several duties: who does which one next, and which commands come of it.
#pragma once

#include <numeric>

#include "decider.hpp"

namespace pursue {

class Dispatch : public Decider {
  public:
    Dispatch(const Game& game, Joints& joints, Duties& duties, const Guess& guess) : Decider(game, joints, duties, guess) {
        if (guess.alternates == Alternates::visits) alternating_ = duties.visits();
        if (guess.alternates == Alternates::long_limits) alternating_ = duties.with_long_limits();
    }

    bool alternates() const override { return !alternating_.empty(); }

    std::vector<int> remembered(const Discrete& d) override {
        std::vector<int> memory(robots(), -1);
        remember(d, memory, std::vector<int>(memory));
        return memory;
    }

    // Which duty each robot is at, -1: none, after a move from d; before, it was at those of `memory`. More than the numbers
    // of automata once: it is a patrol that is put off, and the robot goes to a call first; several times: to that patrol next,
    // or, for one that alternates, that was the last of those that it does in turn with others.
    void remember(const Discrete& d, const Joint& joint, std::vector<int>& memory) override {
        const std::vector<int> last = memory;
        for (std::size_t r = 0; r < memory.size(); ++r) {
            int& duty = memory[r];
            const bool begins = joint.controllable && joint.owner == duties_.robots()[r];
            if (is_waiting(duty) && begins && !goes_to_charger(d, r) && !prepares_first(d, r)) duty -= count_;
            if (duty >= 0 && duties_.touches(d, joint, duty % count_)) duty = -1;
        }
        remember(joint.target(d), memory, last);
    }

    std::vector<Order> decided(const Discrete& d, const std::vector<int>& enabled, const std::vector<int>& memory) override {
        const std::vector<int>& robots = duties_.robots();
        std::vector<int> wanted;
        std::vector<std::set<int>> ways;
        std::vector<bool> waits;
        for (std::size_t r = 0; r < robots.size(); ++r) {
            const bool charges =
                goes_to_charger(d, r) || (duties_.has_less(d, robots[r], 100) && duties_.is_at_charger(d, robots[r]));
            const bool busy = is_waiting(memory[r]) && (charges || prepares_first(d, r));  // it charges while it waits there
            waits.push_back(is_waiting(memory[r]) && !busy);
            const int duty = busy ? -1 : memory[r];
            wanted.push_back(wants(d, enabled, r, duty, ways.emplace_back()));
        }
        std::vector<int> commands = wanted;
        std::vector<std::size_t> for_whom(robots.size());
        std::iota(for_whom.begin(), for_whom.end(), std::size_t{0});
        for (std::size_t q = 0; q < robots.size(); ++q)
            for (std::size_t r = 0; r < robots.size() && wanted[q] >= 0; ++r) {
                if (r == q || !ways[q].count(d[robots[r]]) || !leads_to_loss(together(d, robots[q], robots[r]))) continue;
                const bool blocked = ways[r].count(d[robots[q]]) && leads_to_loss(together(d, robots[r], robots[q]));
                const bool goes = wanted[r] >= 0 && !waits[r];
                if (goes && !blocked) continue;  // by itself
                std::set<int> out, others;
                const int gives = makes_way(d, enabled, robots[r], d[robots[q]], ways[q], out);
                if (goes && gives < 0) continue;
                if (goes && r < q && makes_way(d, enabled, robots[q], d[robots[r]], ways[r], others) >= 0) continue;
                commands[r] = gives;
                for_whom[r] = q;
                if (commands[r] >= 0 && out.count(ended(joints_[wanted[q]].target(d), robots[q])[robots[q]])) commands[q] = -1;
            }
        for (std::size_t q = 0; q < tasks_.load().size() && guess_.by_time; ++q)
            if (commands[q] == wanted[q] && wanted[q] >= 0 && is_in_the_way(d, q, wanted[q], memory, ways[q])) commands[q] = -1;
        for (std::size_t q = 0; q < robots.size(); ++q)
            if (commands[q] == wanted[q] && wanted[q] >= 0 && !waits[q] && traps(d, q, wanted[q], memory, ways[q])) commands[q] = -1;
        // Who can leave only when somebody else is there is relieved by one who has nothing to do.
        for (std::size_t q = 0; q < robots.size(); ++q)
            for (std::size_t r = 0; r < robots.size() && commands[q] >= 0; ++r) {
                if (wanted[r] >= 0 || commands[r] >= 0 || !leads_to_loss(joints_[commands[q]].target(d))) continue;
                if (leads_to_loss(joints_[commands[q]].target(together(d, robots[r], robots[q])))) continue;
                commands[r] = towards(d, enabled, robots[r], d[robots[q]]);
                for_whom[r] = r;
            }
        std::vector<Order> orders;
        for (std::size_t r = 0; r < robots.size(); ++r) {
            // On the way to a post others may always be there first.
            if (commands[r] < 0 || (!tasks_.is_bound(r, d) && leads_to_loss(joints_[commands[r]].target(d)))) continue;
            const std::size_t q = for_whom[r];
            if (!waits[q] || (q == r && commands[r] != wanted[r])) orders.push_back({commands[r]});
            else for (const Bound& since : due(d, q, memory[q] - count_)) orders.push_back({commands[r], since});
        }
        return orders;
    }

  private:
    // The same in a state that is entered with this memory; before it was `last`.
    void remember(const Discrete& d, std::vector<int>& memory, const std::vector<int>& last) {
        for (std::size_t r = 0; r < memory.size(); ++r) {
            int& duty = memory[r];
            const bool again = guess_.next == Next::soonest_due && !charges(d, duty);
            if (duty >= 0 && (again || !duties_.is_open(d, duty % count_))) duty = -1;
            if (guess_.charging == Charging::until_called && charges(d, duty) && is_asked(d, r, memory)) duty = -1;
            if (tasks_.guarded(r, d) >= 0) duty = -1;
            if (is_waiting(duty) && is_called(d, r, memory)) duty = guess_.visits_first ? duty - count_ : -1;
        }
        for (;;) {
            std::tuple<std::int64_t, std::size_t, int> best{Duties::NEVER, 0, -1};
            for (std::size_t r = 0; r < memory.size(); ++r)
                if (memory[r] < 0 && tasks_.guarded(r, d) < 0) best = std::min(best, next_duty(d, r, memory, last[r]));
            const auto [place, robot, duty] = best;
            if (duty < 0) return;
            memory[robot] = duty;
            if (is_put_off(d, robot, duty, memory, last[robot])) memory[robot] += count_;
            else if (is_waiting(last[robot]) && !is_patrol(duty)) memory[robot] += count_ * (2 + last[robot] % count_);
            else if (const int before = last_of_these(last[robot]); before >= 0 && !alternating_[duty])
                memory[robot] += count_ * (2 + before);
        }
    }

    // The next duty for a robot after its last one that no robot is at, behind a number: less is better.
    std::tuple<std::int64_t, std::size_t, int> next_duty(const Discrete& d, std::size_t robot, const std::vector<int>& memory,
                                                         int last) {
        std::tuple<std::int64_t, std::size_t, int> best{Duties::NEVER, robot, -1};
        bool looked = false;
        for (const int a : duties_.watching()) {
            if (!duties_.is_open(d, a) || is_done_by_one(a, memory)) continue;
            if (!looked) duties_.look(d, duties_.robots()[robot]);
            looked = true;
            const std::int64_t cost = duties_.cost(duties_.done(a));
            if (cost == Duties::NEVER || !tasks_.is_for(robot, a)) continue;
            std::int64_t place = alternates() ? alternating(a, last) : in_turn(a, last);
            if (is_waiting(last) && is_patrol(a)) place += 2 * count_;
            if (last >= 2 * count_ && a == last / count_ - 2 && !alternates()) place = -1;
            if (guess_.next == Next::soonest_due) place = duties_.deadline(d, a);
            if (guess_.next == Next::nearest) place = cost;
            if (guess_.charging == Charging::until_called && charges(d, last) && is_call(a)) place = -1;
            best = std::min(best, {place, robot, a});
        }
        return best;
    }

    // The place of a duty among all, after the last one.
    int in_turn(int a, int last) const {
        const int turn = duties_.turn(a);
        return last < 0 || turn > duties_.turn(last % count_) ? turn : turn + count_;
    }

    // The same where some take turns with what else is asked for, of which each time another one comes first.
    int alternating(int a, int last) const {
        if (last < 0) return duties_.turn(a);
        const int before = last_of_these(last);
        const bool again = alternating_[last % count_] == alternating_[a];
        const int turn = alternating_[a] || before < 0 ? in_turn(a, before) : duties_.rotated(a, before, alternating_);
        return (again ? 2 * count_ : 0) + turn;
    }

    // The last of those that a robot does in turn with others, after it was at a duty, -1: not known.
    int last_of_these(int duty) const {
        if (!alternates()) return -1;
        return duty >= 0 && alternating_[duty % count_] ? duty % count_ : std::max(duty / count_ - 2, -1);
    }

    // Whether a robot waits with a patrol that it has put off.
    bool is_waiting(int duty) const { return duty >= count_ && duty < 2 * count_; }

    bool is_done_by_one(int a, const std::vector<int>& memory) const {
        return std::any_of(memory.begin(), memory.end(), [&](int duty) { return duty >= 0 && duty % count_ == a; });
    }

    // Whether a robot's duty is to charge a battery by time, and it does.
    bool charges(const Discrete& d, int duty) const {
        return duty >= 0 && is_charging(duty % count_, d[duty % count_]);
    }

    // Whether a robot that charges when it is idle is away from its charger. While it waits for a patrol it goes there first.
    bool goes_to_charger(const Discrete& d, std::size_t r) const {
        const int battery = duties_.chargers().battery_of(duties_.robots()[r]);
        const bool when_idle = guess_.charging == Charging::when_idle && battery >= 0;
        return when_idle && duties_.is_open(d, battery) && !is_charging(battery, d[battery]);
    }

    // Whether a robot that waits for a patrol does first what has to come before what it will be asked for.
    bool prepares_first(const Discrete& d, std::size_t r) {
        if (guess_.idle != Idle::prepares) return false;
        std::vector<int> enabled;
        std::set<int> way;
        joints_.enabled(d, enabled);
        return prepares(d, enabled, r, way) >= 0;
    }

    // Whether somebody else than a robot asks for what robot r can do and nobody goes for.
    bool is_asked(const Discrete& d, std::size_t r, const std::vector<int>& memory) const {
        return std::any_of(duties_.watching().begin(), duties_.watching().end(), [&](int a) {
            return duties_.is_open(d, a) && tasks_.is_for(r, a) && is_call(a) && !is_done_by_one(a, memory);
        });
    }

    // Whether somebody else than a robot begins the duty of automaton a.
    bool is_call(int a) const {
        const auto& own = game_.automata[a].edges;
        const auto begun = [&](const Edge& sent) {
            return sent.channel >= 0 && sent.sends && std::any_of(own.begin(), own.end(), [&](const Edge& e) {
                return e.channel == sent.channel && !duties_.is_timed(a, e.source) && duties_.is_timed(a, e.target);
            });
        };
        const std::vector<int>& robots = duties_.robots();
        for (int b = 0; b < count_; ++b)
            if (std::find(robots.begin(), robots.end(), b) == robots.end() &&
                std::any_of(game_.automata[b].edges.begin(), game_.automata[b].edges.end(), begun))
                return true;
        return false;
    }

    // Whether somebody has called a robot that nobody else goes for.
    bool is_called(const Discrete& d, std::size_t r, const std::vector<int>& memory) const {
        return std::any_of(duties_.watching().begin(), duties_.watching().end(), [&](int a) {
            return duties_.is_open(d, a) && tasks_.is_for(r, a) && !is_patrol(a) && !is_done_by_one(a, memory);
        });
    }

    // Whether a robot puts off a patrol that is next: nobody calls, and its last duty was no call.
    bool is_put_off(const Discrete& d, std::size_t r, int duty, const std::vector<int>& memory, int last) const {
        const bool begins = last < 0 ? guess_.sets_off : !is_patrol(last % count_);
        return is_patrol(duty) && !begins && !is_called(d, r, memory);
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
        const auto& load = tasks_.load();
        for (std::size_t r = 0; r < load.size(); ++r)
            if (std::pair(load[r], q) > std::pair(load[q], r) && memory[r] >= 0 && comes(d, r, memory[r], there, robot, left))
                return true;
        return false;
    }

    // Whether a command takes robot q to where another one, at a place on q's way, could not leave it any more: a dead end.
    bool traps(const Discrete& d, std::size_t q, int command, const std::vector<int>& memory, const std::set<int>& way) {
        const int robot = duties_.robots()[q];
        const Discrete there = ended(joints_[command].target(d), robot);
        std::vector<int> enabled;
        for (std::size_t r = 0; r < duties_.robots().size(); ++r) {
            const int other = duties_.robots()[r];
            const Discrete then = r == q ? there : ended(there, other);
            if (r == q || !way.count(then[other]) || !leads_to_loss(together(then, robot, other))) continue;
            joints_.enabled(then, enabled);
            const bool busy = memory[r] >= 0 && duties_.is_open(then, memory[r] % count_);
            std::set<int> further, its, out;
            if (busy && wants(then, enabled, r, memory[r], its) >= 0 && !its.count(then[robot])) continue;
            wants(then, enabled, q, memory[q], further);
            if (further.count(then[other]) && makes_way(then, enabled, other, then[robot], further, out) < 0) return true;
        }
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
            if (leads_to_loss(duties_.placed(there, robot, now[robot]))) return true;
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

    std::vector<bool> alternating_;  // by automaton, empty where nothing alternates
};

}  // namespace pursue
