// A policy for robots that are in each other's way: each has a home where it is in nobody's way, and of those whose ways
// cross, one at a time leaves home for a duty, or for several, and comes back before another one leaves.
#pragma once

#include "decider.hpp"

namespace pursue {

class Excursions : public Decider {
  public:
    Excursions(const Game& game, Joints& joints, Duties& duties, const Guess& guess)
        : Decider(game, joints, duties, guess), start_(initial(game)) {
        if (robots() > 1 && !duties.has_batteries()) find_homes();
    }

    // Whether there are such homes, and some ways cross.
    bool applies() const override { return !pairs_.empty(); }

    // Per robot its duty, -1: none, below: on its way home from the one of that number; then the step of the way to the
    // homes that is next, none: -1; then per pair whose trips cross who of the two leaves first.
    std::vector<int> remembered(const Discrete& d) override {
        std::vector<int> memory(robots(), -1);
        memory.push_back(first_steps_.empty() ? -1 : 0);
        for (const auto& [r, s] : pairs_) memory.push_back(static_cast<int>(r));
        if (applies()) assign(d, memory);
        return memory;
    }

    void remember(const Discrete& d, const Joint& joint, std::vector<int>& memory) override {
        const Discrete target = joint.target(d);
        int& step = memory[robots()];
        if (step >= 0) {
            const auto [mover, edge, location] = first_steps_[step];
            if (target[mover] == location && ++step == static_cast<int>(first_steps_.size())) step = -1;
        }
        for (std::size_t r = 0; r < robots(); ++r) {
            const int duty = memory[r];
            const bool done = duty >= 0 && (duties_.touches(d, joint, duty) || !duties_.is_open(target, duty));
            if (done) memory[r] = after(target, r, memory);
            if (joint.controllable && joint.owner == robot(r) && is_home(d, r) && !is_home(target, r)) yields(r, memory);
        }
        assign(target, memory);
    }

    std::vector<Order> decided(const Discrete& d, const std::vector<int>& enabled, const std::vector<int>& memory) override {
        if (const int step = memory[robots()]; step >= 0) {
            const auto [mover, edge, location] = first_steps_[step];
            const int next = command(d, enabled, mover, edge);
            return next < 0 || leads_to_loss(joints_[next].target(d)) ? std::vector<Order>{} : std::vector<Order>{{next}};
        }
        std::vector<int> wanted;
        std::vector<bool> leaves;  // or wants to
        for (std::size_t r = 0; r < robots(); ++r) {
            std::set<int> way;
            const bool returns = memory[r] < 0;
            wanted.push_back(returns ? begins(d, enabled, robot(r), home(r), way) : wants(d, enabled, r, memory[r], way));
            way.erase(homes_[r]);
            leaves.push_back(is_home(d, r) && wanted[r] >= 0 && !way.empty());
        }
        std::vector<Order> orders;
        for (std::size_t r = 0; r < robots(); ++r) {
            if (wanted[r] < 0 || leads_to_loss(joints_[wanted[r]].target(d))) continue;
            if (leaves[r] && !may_leave(d, r, leaves, memory)) continue;
            if (!leaves[r] || !is_patrol(memory[r]) || is_awaited(r, leaves, memory)) orders.push_back({wanted[r]});
            else for (const Bound& since : due(d, r, memory[r])) orders.push_back({wanted[r], since});
        }
        return orders;
    }

  private:
    int robot(std::size_t r) const { return duties_.robots()[r]; }
    int home(std::size_t r) const { return duties_.at_location(robot(r), homes_[r]); }
    bool is_home(const Discrete& d, std::size_t r) const { return d[robot(r)] == homes_[r]; }

    // What a robot is at after a duty: the next one of the same trip, if there is one, or its way home.
    int after(const Discrete& d, std::size_t r, const std::vector<int>& memory) const {
        const int duty = memory[r];
        int next = -1;
        for (const int a : duties_.watching())
            if (guess_.trips == Trips::several && is_next(d, r, a, memory) && duties_.turn(a) > duties_.turn(duty) &&
                (next < 0 || duties_.turn(a) < duties_.turn(next)))
                next = a;
        return next >= 0 ? next : -2 - duty;
    }

    // Whether a duty is open, for robot r, and no robot is at it.
    bool is_next(const Discrete& d, std::size_t r, int a, const std::vector<int>& memory) const {
        const auto end = memory.begin() + static_cast<std::ptrdiff_t>(robots());
        return tasks_.is_for(r, a) && duties_.is_open(d, a) && std::find(memory.begin(), end, a) == end;
    }

    // Gives each robot that is at home without a duty its next one: calls first where patrols wait, else one after the
    // other.
    void assign(const Discrete& d, std::vector<int>& memory) {
        for (std::size_t r = 0; r < robots() && memory[robots()] < 0; ++r) {
            if (!is_home(d, r) || (memory[r] >= 0 && !is_patrol(memory[r]))) continue;
            const int last = memory[r] < -1 ? duties_.turn(-2 - memory[r]) : -1, before = memory[r];
            std::tuple<bool, int, int> best{true, 2 * count_, -1};
            for (const int a : duties_.watching()) {
                if (a != before && !is_next(d, r, a, memory)) continue;
                const int turn = duties_.turn(a);
                best = std::min(best, {is_patrol(a), turn > last ? turn : turn + count_, a});
            }
            memory[r] = before >= 0 && is_patrol(std::get<2>(best)) ? before : std::get<2>(best);
        }
    }

    // Whether robot r may leave home: of those whose trips cross its own nobody is away, and nobody who leaves first wants
    // to.
    bool may_leave(const Discrete& d, std::size_t r, const std::vector<bool>& leaves, const std::vector<int>& memory) const {
        for (std::size_t n = 0; n < pairs_.size(); ++n) {
            const auto [one, other] = pairs_[n];
            if (one != r && other != r) continue;
            const std::size_t s = one == r ? other : one, first = memory[robots() + 1 + n];
            if (!is_home(d, s) || (leaves[s] && first == s && !waits(r, s, memory))) return false;
        }
        return true;
    }

    // Lets all others leave before robot r the next time: so robots never wait in a circle (Chandy and Misra 1984).
    void yields(std::size_t r, std::vector<int>& memory) const {
        for (std::size_t n = 0; n < pairs_.size(); ++n) {
            const auto [one, other] = pairs_[n];
            if (one == r || other == r) memory[robots() + 1 + n] = static_cast<int>(one == r ? other : one);
        }
    }

    // Whether two patrols wait, each until it is due.
    bool waits(std::size_t r, std::size_t s, const std::vector<int>& memory) const {
        return is_patrol(memory[r]) && is_patrol(memory[s]);
    }

    // Whether somebody who is called has to wait until robot r is back.
    bool is_awaited(std::size_t r, const std::vector<bool>& leaves, const std::vector<int>& memory) const {
        return std::any_of(pairs_.begin(), pairs_.end(), [&](const auto& pair) {
            const std::size_t s = pair.first == r ? pair.second : pair.first;
            return (pair.first == r || pair.second == r) && leaves[s] && !is_patrol(memory[s]);
        });
    }

    // A home, where a robot is on its trips from there, and how long these take, the way there at first included.
    struct HomeTrips {
        int home;
        std::set<int> locations;
        std::int64_t time = 0;
    };

    // The first homes, short trips first, at which no robot is in another's way.
    void find_homes() {
        std::vector<std::vector<HomeTrips>> all;
        for (std::size_t r = 0; r < robots(); ++r) {
            auto& own = all.emplace_back();
            for (const int location : duties_.rests(robot(r)))
                if (HomeTrips trips{location, {location}}; takes(r, trips)) own.push_back(std::move(trips));
            std::stable_sort(own.begin(), own.end(), [](const HomeTrips& x, const HomeTrips& y) { return x.time < y.time; });
        }
        std::vector<const HomeTrips*> chosen;
        if (!choose(all, chosen)) return;
        for (const HomeTrips* each : chosen) homes_.push_back(each->home);
        if (!find_first_steps()) return;
        for (std::size_t r = 0; r < robots(); ++r)
            for (std::size_t s = r + 1; s < robots(); ++s)
                if (cross(r, chosen[r]->locations, s, chosen[s]->locations)) pairs_.emplace_back(r, s);
    }

    // The ways of all robots from where they begin to their homes, one step of one robot after the other. False: not found.
    bool find_first_steps() {
        States met(start_.size());
        std::vector<std::tuple<int, int, int, int>> steps{{-1, -1, -1, -1}};  // the state before, then as `first_steps_`
        std::vector<int> enabled;
        met.number(start_);
        for (int k = 0; k < static_cast<int>(met.size()) && k < MOST_CHOICES; ++k) {
            const Discrete d = met[k];
            bool home = true;
            for (std::size_t r = 0; r < robots(); ++r) home &= is_home(d, r);
            if (home) {
                for (int n = k; n > 0; n = std::get<0>(steps[n])) {
                    const auto [before, mover, edge, location] = steps[n];
                    first_steps_.insert(first_steps_.begin(), {mover, edge, location});
                }
                return true;
            }
            joints_.enabled(d, enabled);
            for (const int j : enabled) {
                const Joint& joint = joints_[j];
                if (!joint.controllable || !is_robot(joint.owner) || leads_to_loss(joint.target(d))) continue;
                const Discrete after = ended(joint.target(d), joint.owner);
                const std::size_t known = met.size();
                if (after[joint.owner] == d[joint.owner] || duties_.is_timed(joint.owner, after[joint.owner])) continue;
                met.number(after);
                if (met.size() > known) steps.emplace_back(k, joint.owner, joint.edges[0], after[joint.owner]);
            }
        }
        return false;
    }

    // Chooses a home for each further robot, depth first.
    bool choose(const std::vector<std::vector<HomeTrips>>& all, std::vector<const HomeTrips*>& chosen) {
        const std::size_t r = chosen.size();
        if (r == all.size()) return true;
        if (++choices_ > MOST_CHOICES) return false;
        for (const HomeTrips& trips : all[r]) {
            bool fits = true;
            for (std::size_t s = 0; s < r && fits; ++s)
                fits = !cross(r, {trips.home}, s, chosen[s]->locations) && !cross(s, {chosen[s]->home}, r, trips.locations);
            if (!fits) continue;
            chosen.push_back(&trips);
            if (choose(all, chosen)) return true;
            chosen.pop_back();
        }
        return false;
    }

    // Whether two robots must not be at two of these locations.
    bool cross(std::size_t r, const std::set<int>& mine, std::size_t s, const std::set<int>& others) {
        for (const int one : mine)
            for (const int other : others) {
                const auto [known, fresh] = crossing_.try_emplace({r, one, s, other}, false);
                if (fresh) known->second = leads_to_loss(apart(r, one, s, other));
                if (known->second) return true;
            }
        return false;
    }

    // The start, with two robots at locations and the others nowhere.
    Discrete apart(std::size_t r, int one, std::size_t s, int other) const {
        Discrete d = start_;
        for (std::size_t t = 0; t < robots(); ++t) {
            if (t == r || t == s) continue;
            d[robot(t)] = duties_.rests(robot(t)).front();
            for (const Edge& edge : game_.automata[robot(t)].edges)
                for (const auto& set : edge.assign) d[game_.automata.size() + set.variable] = -1;
        }
        return duties_.placed(duties_.placed(d, robot(r), one), robot(s), other);
    }

    // Looks at all trips of a robot from its home and back. False: there is one that it cannot make.
    bool takes(std::size_t r, HomeTrips& trips) {
        duties_.look(start_, robot(r));
        const std::int64_t first = duties_.cost(duties_.at_location(robot(r), trips.home));
        if (first == Duties::NEVER) return false;
        trips.time = first % Duties::DETOUR;
        std::set<int> met{trips.home};
        std::vector<int> open{trips.home};
        while (!open.empty()) {
            const int from = open.back();
            open.pop_back();
            for (const int a : duties_.watching()) {
                if (!tasks_.is_for(r, a)) continue;
                const int end = trip(r, a, from, trips);
                if (end < 0) return false;
                if (guess_.trips == Trips::several && met.insert(end).second) open.push_back(end);
            }
        }
        return true;
    }

    // A trip for the duty of automaton a, and home; where the duty ends, -1: it cannot be made.
    int trip(std::size_t r, int a, int from, HomeTrips& trips) {
        Discrete d = opened(duties_.placed(start_, robot(r), from), a);
        std::vector<int> enabled;
        for (int step = 0; step < STEPS_AHEAD && duties_.is_open(d, a); ++step) {
            std::set<int> way;
            joints_.enabled(d, enabled);
            const int next = begins(d, enabled, robot(r), duties_.done(a), way);
            if (step == 0 && duties_.cost(duties_.done(a)) == Duties::NEVER) return -1;
            trips.locations.insert(way.begin(), way.end());
            if (step == 0) trips.time += duties_.cost(duties_.done(a)) % Duties::DETOUR;
            if (next < 0) break;  // what somebody else ends comes first
            d = ended(joints_[next].target(d), robot(r));
        }
        const int end = d[robot(r)];
        duties_.look(d, robot(r));
        const int back = duties_.at_location(robot(r), trips.home);
        if (duties_.cost(back) == Duties::NEVER) return -1;
        const std::set<int> way = duties_.way(back, robot(r));
        trips.locations.insert(way.begin(), way.end());
        trips.time += duties_.cost(back) % Duties::DETOUR;
        return end;
    }

    // The state after somebody has begun the duty of automaton a, wherever he has to be for it.
    Discrete opened(Discrete d, int a) {
        if (duties_.is_open(d, a)) return d;
        std::vector<int> enabled;
        for (const Edge& begun : game_.automata[a].edges)
            for (int b = 0; b < count_ && begun.channel >= 0 && duties_.is_timed(a, begun.target); ++b)
                for (const Edge& sent : game_.automata[b].edges) {
                    if (sent.channel != begun.channel || !sent.sends || is_robot(b)) continue;
                    joints_.enabled(duties_.placed(d, b, sent.source), enabled);
                    for (const int j : enabled)
                        if (joints_[j].owner == b && duties_.is_open(joints_[j].target(d), a)) {
                            const int before = d[b];
                            d = joints_[j].target(d);
                            d[b] = before;
                            return d;
                        }
                }
        for (int l = static_cast<int>(game_.automata[a].invariants.size()) - 1; l >= 0; --l)
            if (duties_.is_timed(a, l)) d[a] = l;
        return d;
    }

    bool is_robot(int a) const {
        const std::vector<int>& robots = duties_.robots();
        return std::find(robots.begin(), robots.end(), a) != robots.end();
    }

    static constexpr int MOST_CHOICES = 10000;  // of homes, and states on the way there

    const Discrete start_;
    int choices_ = 0;
    std::vector<int> homes_;                                   // per robot, none: there are none
    std::vector<std::tuple<int, int, int>> first_steps_;       // to the homes: the robot, its edge, and where that leads
    std::vector<std::pair<std::size_t, std::size_t>> pairs_;   // of robots whose trips cross
    std::map<std::tuple<std::size_t, int, std::size_t, int>, bool> crossing_;  // per robot and location, twice
};

}  // namespace pursue
