// Policies for several duties: which there are, whose duty each one is, and where a robot waits for its own.
#pragma once

#include "duties.hpp"

namespace pursue {

// Which duty is next for a robot.
enum class Next { in_turn, soonest_due, nearest };

// What a robot does that owes nothing: it stays, goes back to where it began, or to its post, or does what has to come before
// what it will be asked for.
enum class Idle { stays, goes_home, goes_to_post, prepares };

// What a robot does in turn with anything else that it is asked for: visits, or what has the longest limits.
enum class Alternates { nothing, visits, long_limits };

// When a robot that has a battery by time goes to its charger: in its turn, until it is full; likewise, but it leaves when it
// is called; or when it has nothing else to do, until it has.
enum class Charging { in_turn, until_called, when_idle };

// Whether robots whose ways cross leave home one at a time: for one duty each, or for several in turn.
enum class Trips { none, one, several };

struct Guess {
    Next next = Next::in_turn;
    bool shared_out = true;  // each duty is one robot's: who has least to do
    Idle idle = Idle::stays;
    std::size_t zones = 1;   // more zones of one state become one, which only adds plays
    bool apart = true;       // but only those that the same agent's moves lead to: then its pause has just begun
    bool by_time = false;    // duties are shared out by how long they take; who has more to do has the right of way
    std::vector<int> patrols{};  // duties that wait until they are due
    int reserve = 0;         // the part of their period, in hundredths, that is left then beside the way
    bool sets_off = false;   // but the first one is begun at once
    bool relieved = false;   // a post is for a robot without duties; until it is there, another one sees to the post first
    Alternates alternates = Alternates::nothing;  // after each of these something else, if it is asked for
    int charge = 0;          // a robot that charges goes on until its battery has so many hundredths
    Charging charging = Charging::in_turn;
    Trips trips = Trips::none;
    bool visits_first = false;  // who is called while it waits for a patrol sees to that first, though it is not due

    // Whether another one is the same where no robot has several duties.
    bool needs_several() const {
        const bool of_several = next != Next::in_turn || alternates != Alternates::nothing || trips == Trips::one;
        return of_several && !by_time && !relieved;
    }
};

inline constexpr std::size_t BOUNDS_OF_A_STATE = 1024;  // a look at one takes about as long as at so many bounds

class Tasks {
  public:
    Tasks(const Game& game, Duties& duties, const Guess& guess) : game_(game), duties_(duties), guess_(guess) {
        for (const int robot : duties.robots()) {
            auto& own = for_.emplace_back();
            for (int a = 0; a < static_cast<int>(game.automata.size()); ++a) own.push_back(watches(game, a) && duties.can(robot, a));
            homes_.push_back(guess.idle == Idle::goes_home ? duties.at_location(robot, game.automata[robot].initial) : -1);
        }
        for (std::size_t r = 0; r < duties.robots().size() && guess.charging == Charging::when_idle; ++r)
            if (const int battery = duties.chargers().battery_of(duties.robots()[r]); battery >= 0) {
                for_[r][battery] = false;
                homes_[r] = duties.at_charger(battery);
            }
        for (const int robot : duties.robots()) duties.keep_out(robot, dangers(robot));
        if (guess.shared_out && duties.robots().size() > 1) share_out();
        if (guess.idle == Idle::goes_to_post) find_posts();
        if (guess.relieved) find_guards();
    }

    // Per robot how long its duties take it, none: they are not shared out.
    const std::vector<std::int64_t>& load() const { return load_; }

    // Whether the duty of automaton a is for robot r: it can do it, and it is not another's.
    bool is_for(std::size_t r, int a) const { return for_[r][a]; }

    // The fact that a robot is where it goes when it owes nothing; -1: it stays.
    int home(std::size_t r) const { return homes_[r]; }

    // Whether several robots may see to one duty.
    bool has_choice() const {
        return std::any_of(duties_.watching().begin(), duties_.watching().end(), [&](int a) {
            return std::count_if(for_.begin(), for_.end(), [&](const auto& own) { return own[a]; }) > 1;
        });
    }

    // Whether a robot may have several duties.
    bool has_several() const {
        return std::any_of(for_.begin(), for_.end(), [](const auto& own) { return std::count(own.begin(), own.end(), true) > 1; });
    }

    // Whether some robot is relieved by another.
    bool has_guards() const { return !guards_.empty(); }

    // The fact that robot r is at the post to which it sees before its duties, as who is to stay there has not come yet; -1:
    // there is none.
    int guarded(std::size_t r, const Discrete& d) const {
        for (const Guard& guard : guards_)
            if (guard.robot == r && d[guard.other] != guard.post) return duties_.at_location(duties_.robots()[r], guard.own);
        return -1;
    }

    // Whether robot r sees to a post, or is on its way to relieve who does.
    bool is_bound(std::size_t r, const Discrete& d) const {
        return std::any_of(guards_.begin(), guards_.end(), [&](const Guard& guard) {
            return (guard.robot == r || guard.other == duties_.robots()[r]) && d[guard.other] != guard.post;
        });
    }

  private:
    // A robot that is at its own location until another one is at its post.
    struct Guard {
        std::size_t robot;
        int own, other, post;  // `other`: an automaton
    };

    // Who is needed at a post and has no duties goes there; who is there sooner, and has some, is there until then.
    void find_guards() {
        const Discrete start = initial(game_);
        const auto has_duties = [&](std::size_t r) { return std::find(for_[r].begin(), for_[r].end(), true) != for_[r].end(); };
        for (const int a : duties_.watching()) {
            std::vector<std::tuple<std::int64_t, std::size_t, int>> who;
            for (const auto& [r, location] : required(start, a)) {
                duties_.look(start, duties_.robots()[r]);
                who.emplace_back(duties_.cost(duties_.at_location(duties_.robots()[r], location)), r, location);
            }
            std::sort(who.begin(), who.end());
            const auto stays = std::find_if(who.begin(), who.end(), [&](const auto& each) {
                return homes_[std::get<1>(each)] < 0 && !has_duties(std::get<1>(each));
            });
            if (stays == who.end() || std::get<0>(*stays) == Duties::NEVER) continue;
            const auto [far, robot, post] = *stays;
            homes_[robot] = duties_.at_location(duties_.robots()[robot], post);
            if (stays != who.begin() && has_duties(std::get<1>(who.front())))
                guards_.push_back({std::get<1>(who.front()), std::get<2>(who.front()), duties_.robots()[robot], post});
        }
    }

    // Gives each duty to one of the robots that can do it: those that few can do first, then perhaps what takes longest.
    void share_out() {
        const std::size_t robots = duties_.robots().size();
        std::vector<std::tuple<std::vector<std::size_t>, std::int64_t, int>> able;  // who, its time, the duty
        for (const int a : duties_.watching()) {
            std::vector<std::size_t> who;
            std::int64_t time = 0;
            for (std::size_t r = 0; r < robots; ++r)
                if (for_[r][a]) {
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
            for (const std::size_t r : who) for_[r][a] = r == least;
        }
    }

    // About how long a robot takes for the duty of automaton a from where it begins.
    std::int64_t time_for(int robot, int a) {
        Discrete d = initial(game_);
        const auto& bounds = game_.automata[a].invariants;
        const auto open = std::find_if(bounds.begin(), bounds.end(), [](const auto& some) { return !some.empty(); });
        if (open != bounds.end()) d[a] = static_cast<int>(open - bounds.begin());
        duties_.look(d, robot);
        const std::int64_t cost = duties_.cost(duties_.done(a));
        return cost == Duties::NEVER ? 0 : cost;
    }

    // A robot's post is where it has to be lest something happen that has no deadline; else the place from which the worst
    // of its duties takes the least part of its time.
    void find_posts() {
        const Discrete start = initial(game_);
        for (const int a : duties_.watching()) {
            std::int64_t least = Duties::NEVER;
            std::size_t who = duties_.robots().size();
            int post = -1;
            for (const auto& [r, location] : required(start, a)) {
                const int fact = duties_.at_location(duties_.robots()[r], location);
                duties_.look(start, duties_.robots()[r]);
                if ((homes_[r] >= 0 && homes_[r] != fact) || duties_.cost(fact) >= least) continue;
                std::tie(least, who, post) = std::tuple(duties_.cost(fact), r, fact);
            }
            if (who < duties_.robots().size()) homes_[who] = post;
        }
        for (std::size_t r = 0; r < duties_.robots().size(); ++r)
            if (homes_[r] < 0) homes_[r] = in_the_middle(start, r);
    }

    // The robots that keep automaton a from what is to be avoided by being at a location, and only there.
    std::vector<std::pair<std::size_t, int>> required(const Discrete& start, int a) const {
        std::vector<std::pair<std::size_t, int>> out;
        for (const Edge& edge : game_.automata[a].edges)
            for (std::size_t r = 0; r < duties_.robots().size() && duties_.is_loss(a, edge) && !duties_.is_timed(a, edge.source); ++r) {
                const int robot = duties_.robots()[r];
                std::vector<int> places;
                for (const int location : duties_.rests(robot))
                    if (prevents(duties_.placed(start, robot, location), robot, edge)) places.push_back(location);
                if (places.size() == 1) out.emplace_back(r, places.front());
            }
        return out;
    }

    // Whether an edge cannot be taken because of what a robot is at, whatever the others do.
    bool prevents(const Discrete& d, int robot, const Edge& edge) const {
        const auto is_own = [&](const Test& test) { return is_set_by(robot, test); };
        const auto holds = [&](const Test& test) { return d[game_.automata.size() + test.variable] == test.value; };
        return std::any_of(edge.clauses.begin(), edge.clauses.end(), [&](const auto& clause) {
            return std::all_of(clause.begin(), clause.end(), is_own) && std::none_of(clause.begin(), clause.end(), holds);
        });
    }

    // Where a robot must not be when somebody is somewhere whom no robot of the game moves.
    std::set<int> dangers(int robot) const {
        const Discrete start = initial(game_);
        const std::size_t places = game_.automata[robot].invariants.size();
        std::set<int> out;
        for (const int a : duties_.watching())
            for (const Edge& edge : game_.automata[a].edges) {
                if (!duties_.is_loss(a, edge) || duties_.is_timed(a, edge.source)) continue;
                std::set<int> some;
                for (int location = 0; location < static_cast<int>(places); ++location)
                    if (is_danger(duties_.placed(start, robot, location), robot, edge)) some.insert(location);
                if (2 * some.size() < places) out.insert(some.begin(), some.end());  // else it has to be somewhere
            }
        return out;
    }

    // Whether an edge may be taken because of where a robot is, whatever all robots do.
    bool is_danger(const Discrete& d, int robot, const Edge& edge) const {
        const auto& robots = duties_.robots();
        bool depends = false;
        for (const auto& clause : edge.clauses) {
            const auto holds = [&](const Test& test) {
                return is_set_by(robot, test) && d[game_.automata.size() + test.variable] == test.value;
            };
            const auto is_robots = [&](const Test& test) {
                return std::any_of(robots.begin(), robots.end(), [&](int r) { return is_set_by(r, test); });
            };
            if (std::any_of(clause.begin(), clause.end(), holds)) depends = true;
            else if (std::all_of(clause.begin(), clause.end(), is_robots)) return false;
        }
        return depends;
    }

    // Whether an automaton sets the variable that is tested.
    bool is_set_by(int a, const Test& test) const {
        const auto& edges = game_.automata[a].edges;
        return std::any_of(edges.begin(), edges.end(), [&](const Edge& e) {
            return std::any_of(e.assign.begin(), e.assign.end(), [&](const Test& set) { return set.variable == test.variable; });
        });
    }

    // The location from which the worst of a robot's duties takes the least part of its time, -1: it has none.
    int in_the_middle(const Discrete& start, std::size_t r) {
        const int robot = duties_.robots()[r];
        double best = std::numeric_limits<double>::infinity();
        int middle = -1;
        for (const int location : duties_.rests(robot)) {
            double worst = -1;
            for (const int a : duties_.watching()) {
                if (!is_for(r, a)) continue;
                Discrete d = duties_.placed(start, robot, location);
                worst = std::max(worst, 0.0);
                for (const Edge& edge : game_.automata[a].edges) {
                    if (duties_.is_timed(a, edge.source) || !duties_.is_timed(a, edge.target) || prevents(d, robot, edge)) continue;
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

    const Game& game_;
    Duties& duties_;
    const Guess guess_;
    std::vector<std::int64_t> load_;
    std::vector<std::vector<bool>> for_;  // by robot and automaton
    std::vector<int> homes_;
    std::vector<Guard> guards_;
};

}  // namespace pursue
