// What is owed where something has a deadline, and what to do about it first: a plan by time in the relaxed problem
// (delete relaxation, costs added up as in h_add: Bonet and Geffner 2001).
#pragma once

#include <limits>
#include <map>
#include <queue>
#include <set>
#include <utility>

#include "batteries.hpp"
#include "chargers.hpp"

namespace pursue {

class Duties {
  public:
    static constexpr std::int64_t NEVER = std::numeric_limits<std::int64_t>::max();
    static constexpr std::int64_t DETOUR = std::int64_t{1} << 40;  // longer than any way

    explicit Duties(const Game& game)
        : game_(game), looked_from_(game.automata.size() + game.variables.size() + 2),
          losses_(game.automata.size() + game.variables.size()) {
        const int count = static_cast<int>(game.automata.size());
        for (int a = 0; a < count; ++a) {
            const auto& edges = game.automata[a].edges;
            const bool acts = std::any_of(edges.begin(), edges.end(), [](const Edge& e) {
                return e.controllable && (e.channel < 0 || e.sends);
            });
            if (watches(game, a)) watching_.push_back(a);
            else if (acts) robots_.push_back(a);
        }
        chargers_ = Chargers(game, watching_, robots_);
        for (int a = 0; a < count; ++a) {
            for (const Edge& edge : game.automata[a].edges) {
                if (edge.channel >= 0 && !edge.sends) continue;
                if (is_loss(a, edge) || (!edge.controllable && game.automata[a].invariants[edge.source].empty())) continue;
                add_operator(a, edge, -1, nullptr);
                for (int b = 0; edge.channel >= 0 && b < count; ++b)
                    for (const Edge& other : game.automata[b].edges)
                        if (b != a && other.channel == edge.channel && !other.sends && !is_loss(b, other))
                            add_operator(a, edge, b, &other);
            }
        }
        detours_.resize(facts_);
        for (const int robot : robots_)
            if (const auto battery = battery_of(game, robot)) batteries_.emplace(robot, *battery);
        set_turns();
    }

    const std::vector<int>& robots() const { return robots_; }      // automata that commands move
    const std::vector<int>& watching() const { return watching_; }  // automata that watch what is to be avoided

    // The turn of the duty of automaton a among all. What is done at one place comes one after the other, what is done by
    // coming there last: that is done by then.
    int turn(int a) const { return turns_[a]; }

    // The place of a duty among the others than `these`, each time another one first, after one of these.
    int rotated(int a, int after, const std::vector<bool>& these) const {
        const auto before = [&](int b, bool among) {
            return std::count_if(watching_.begin(), watching_.end(), [&](int c) { return these[c] == among && turns_[c] < turns_[b]; });
        };
        const auto others = std::count_if(watching_.begin(), watching_.end(), [&](int c) { return !these[c]; });
        return static_cast<int>((before(a, false) + before(after, true)) % others);
    }

    // The duties that are done by coming somewhere, as that of a patrol is, by automaton.
    const std::vector<bool>& visits() const { return visits_; }

    // The duties that have the longest limits, four fifths of the longest of all or more, by automaton; none if all have.
    std::vector<bool> with_long_limits() const {
        std::vector<wide_t> limits(game_.automata.size());
        for (const int a : watching_)
            for (const auto& bounds : game_.automata[a].invariants)
                if (!bounds.empty()) limits[a] = std::max(limits[a], bounds.front().raw);
        const wide_t longest = *std::max_element(limits.begin(), limits.end());
        std::vector<bool> out;
        for (const wide_t limit : limits) out.push_back(limit * 5 >= longest * 4);
        const auto has = [&](int a) { return out[a]; };
        return std::all_of(watching_.begin(), watching_.end(), has) ? std::vector<bool>{} : out;
    }

    // Whether a deadline of automaton a is running in d.
    bool is_open(const Discrete& d, int a) const { return !game_.automata[a].invariants[d[a]].empty(); }

    // The deadline itself, raw.
    wide_t deadline(const Discrete& d, int a) const { return game_.automata[a].invariants[d[a]].front().raw; }

    // Whether an edge of automaton a leads to what is to be avoided.
    bool is_loss(int a, const Edge& edge) const {
        return std::any_of(game_.bad.begin(), game_.bad.end(), [&](const Place& p) {
            return p.automaton == a && p.location == edge.target;
        });
    }

    // The fact that the duty of automaton a has been done; that it is at a location.
    int done(int a) const { return known(-1 - a, 0); }
    int at_location(int a, int location) const { return known(a, location); }

    bool has_batteries() const { return !batteries_.empty(); }

    // Whether a robot has a battery with less than so many hundredths of what it holds.
    bool has_less(const Discrete& d, int robot, int hundredths) const {
        const auto found = batteries_.find(robot);
        return found != batteries_.end() && 100 * d[found->second.level] < hundredths * found->second.full;
    }

    // Whether a robot is where it can begin to charge.
    bool is_at_charger(const Discrete& d, int robot) const {
        const auto& edges = game_.automata[robot].edges;
        const std::set<int> there = charging(robot);
        return std::any_of(edges.begin(), edges.end(), [&](const Edge& e) { return e.source == d[robot] && there.count(e.target); });
    }

    // The locations of a robot that charges, none: it has no battery.
    std::set<int> charging(int robot) const {
        const auto found = batteries_.find(robot);
        return found == batteries_.end() ? std::set<int>{} : found->second.charging;
    }

    const Chargers& chargers() const { return chargers_; }

    // Whether from a state the ends of what is under way lead to what is to be avoided, as far as that was asked.
    Answers& losses() { return losses_; }

    // The fact that the robot of a battery by time is at its charger.
    int at_charger(int a) const { return at_location(chargers_.robot(a), chargers_.place(a)); }

    // Whether something that a robot does, or its end, does the duty of automaton a.
    bool can(int robot, int a) const {
        if (chargers_.watches(a)) return chargers_.robot(a) == robot;
        const int fact = done(a);
        return std::any_of(operators_.begin(), operators_.end(), [&](const Operator& op) {
            return op.owner == robot && std::find(op.effects.begin(), op.effects.end(), fact) != op.effects.end();
        });
    }

    // What every fact costs in time from d on, where of the robots only this one acts, and not by way of the location
    // `closed`. For `cost`, `first` and `way`, until the next look. Policies look from the same states again and again.
    void look(const Discrete& d, int robot, int closed = -1) {
        Discrete key = d;
        key.push_back(robot);
        key.push_back(closed);
        if (looks_.size() * static_cast<std::size_t>(facts_) > MOST_KEPT) forget();
        const auto number = static_cast<std::size_t>(looked_from_.number(key));
        if (number == looks_.size()) {
            if (has_batteries()) spend(ZONES_OF_A_LOOK);  // of which a robot that looks ahead needs very many
            looks_.push_back(costs_from(d, robot, closed));
        }
        now_ = &looks_[number];
    }

    // From now on a robot takes a way past these locations only where there is no other.
    void keep_out(int robot, const std::set<int>& locations) {
        for (const int location : locations)
            if (const int fact = known(robot, location); fact >= 0 && std::exchange(detours_[fact], DETOUR) != DETOUR) forget();
    }

    std::int64_t cost(int fact) const { return fact < 0 ? NEVER : now_->costs[fact]; }

    // The sender edge that begins the plan to a fact which costs something, -1: it begins with the end of something. Of what
    // an action needs, a robot sees first to what is not its own place: else it would go to and fro.
    int first(int fact) const {
        for (;;) {
            const Operator& op = operators_[now_->achiever[fact]];
            int worst = -1, own = -1;
            for (const int need : op.needs) {
                const int given = now_->support[need];
                if (now_->costs[given] == 0) continue;
                if (about_[given] == op.owner) own = given;
                else if (worst < 0 || now_->costs[given] > now_->costs[worst]) worst = given;
            }
            if (worst < 0) worst = own;
            if (worst < 0) return op.controllable ? op.edge : -1;
            fact = worst;
        }
    }

    // The locations of a robot on the plan to a fact.
    std::set<int> way(int fact, int robot) const {
        std::set<int> met, locations;
        std::vector<int> open{fact};
        while (!open.empty()) {
            const int next = open.back();
            open.pop_back();
            if (!met.insert(next).second) continue;
            if (about_[next] == robot) locations.insert(values_[next]);
            if (now_->achiever[next] < 0) continue;
            // Also where it comes with the last step: what is done by coming somewhere has no need of being there.
            for (const int effect : operators_[now_->achiever[next]].effects)
                if (about_[effect] == robot) locations.insert(values_[effect]);
            for (const int need : operators_[now_->achiever[next]].needs) open.push_back(now_->support[need]);
        }
        return locations;
    }

    bool is_timed(int a, int location) const { return !game_.automata[a].invariants[location].empty(); }

    // Where a robot may stay.
    std::vector<int> rests(int robot) const {
        std::vector<int> out;
        for (int location = 0; location < static_cast<int>(game_.automata[robot].invariants.size()); ++location)
            if (!is_timed(robot, location)) out.push_back(location);
        return out;
    }

    // The state with a robot at a location.
    Discrete placed(Discrete d, int robot, int location) const {
        d[robot] = location;
        for (const Edge& edge : game_.automata[robot].edges)
            if (edge.target == location)
                for (const auto& set : edge.assign) d[game_.automata.size() + set.variable] = set.value;
        return d;
    }

    // Whether a joint move from d does the duty of automaton a, or begins it anew.
    bool touches(const Discrete& d, const Joint& joint, int a) const {
        for (const auto& [index, value] : joint.writes)
            if (index == a && value != d[a]) return !chargers_.watches(a) || !is_timed(a, value);
        const auto& bounds = game_.automata[a].invariants[d[a]];
        return std::any_of(bounds.begin(), bounds.end(), [&](const Bound& b) {
            return std::find(joint.resets.begin(), joint.resets.end(), b.i) != joint.resets.end();
        });
    }

  private:
    using Entry = std::tuple<std::int64_t, int, int>;  // cost, operator, fact

    struct Operator {
        int edge, owner;
        bool controllable;
        std::int64_t time;
        std::vector<int> needs;  // its preconditions
        std::vector<int> effects;
    };

    struct Look {
        std::vector<std::int64_t> costs;  // per fact
        std::vector<int> achiever;        // per fact the operator that achieves it first, -1: none
        std::vector<int> support;         // per precondition the fact that meets it first, -1: none
    };

    static constexpr std::size_t ZONES_OF_A_LOOK = 64;  // it takes about as long as so many zones
    static constexpr std::size_t MOST_KEPT = 1 << 20;  // costs of facts, some 20 bytes each

    Look costs_from(const Discrete& d, int robot, int closed) const {
        Look out{std::vector<std::int64_t>(facts_, NEVER), std::vector<int>(facts_, -1), std::vector<int>(preconditions_.size(), -1)};
        std::vector<std::size_t> met(operators_.size());
        std::vector<std::int64_t> sums(operators_.size());
        std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
        for (std::size_t k = 0; k < d.size(); ++k)
            if (const int fact = known(static_cast<int>(k), d[k]); fact >= 0) queue.emplace(0, -1, fact);
        while (!queue.empty()) {
            const auto [cost, by, fact] = queue.top();
            queue.pop();
            if (out.costs[fact] != NEVER || (about_[fact] == robot && values_[fact] == closed)) continue;
            out.costs[fact] = cost;
            out.achiever[fact] = by;
            for (const int need : met_by_[fact]) {
                if (out.support[need] >= 0) continue;
                out.support[need] = fact;
                const int number = preconditions_[need];
                const Operator& op = operators_[number];
                sums[number] += cost;
                if (++met[number] < op.needs.size()) continue;
                if (op.controllable && op.owner != robot && is_robot(op.owner)) continue;
                for (const int effect : op.effects) queue.emplace(sums[number] + op.time + detours_[effect], number, effect);
            }
        }
        return out;
    }

    void set_turns() {
        std::map<std::pair<int, int>, int> first;  // by robot and location
        std::vector<std::tuple<int, bool, int>> order;
        for (const int a : watching_) {
            int turn = a;
            bool comes = false;
            const int fact = done(a);
            for (const Operator& op : operators_) {
                if (!is_robot(op.owner) || std::find(op.effects.begin(), op.effects.end(), fact) == op.effects.end()) continue;
                const auto& edges = game_.automata[op.owner].edges;
                const auto end = std::find_if(edges.begin(), edges.end(), [&](const Edge& e) { return e.id == op.edge; });
                const auto stays = [&](const Edge& e) { return e.target == end->source && e.source == end->target; };
                comes |= std::none_of(edges.begin(), edges.end(), stays);
                turn = std::min(turn, first.try_emplace({op.owner, end->target}, a).first->second);
            }
            order.emplace_back(turn, comes, a);
        }
        std::sort(order.begin(), order.end());
        turns_.resize(game_.automata.size(), -1);
        visits_.resize(game_.automata.size());
        for (const auto& [turn, comes, a] : order) visits_[a] = comes || chargers_.watches(a);
        for (std::size_t n = 0; n < order.size(); ++n) turns_[std::get<2>(order[n])] = watching_[n];
    }

    void forget() {
        looks_.clear();
        looked_from_ = States(looked_from_.width());
    }

    bool is_robot(int a) const { return std::find(robots_.begin(), robots_.end(), a) != robots_.end(); }

    int known(int what, int value) const {
        const auto found = numbers_.find({what, value});
        return found == numbers_.end() ? -1 : found->second;
    }

    int fact(int what, int value) {
        const auto [found, fresh] = numbers_.try_emplace({what, value}, facts_);
        if (fresh) {
            ++facts_;
            about_.push_back(what);
            values_.push_back(value);
            met_by_.emplace_back();
        }
        return found->second;
    }

    void add_need(Operator& op, const std::vector<int>& any) {
        const int need = static_cast<int>(preconditions_.size());
        op.needs.push_back(need);
        preconditions_.push_back(static_cast<int>(operators_.size()));
        for (const int fact : any) met_by_[fact].push_back(need);
    }

    void add_part(Operator& op, int automaton, const Edge& edge) {
        const int base = static_cast<int>(game_.automata.size());
        add_need(op, {fact(automaton, edge.source)});
        for (const auto& clause : edge.clauses) {
            std::vector<int> any;
            for (const auto& test : clause) any.push_back(fact(base + test.variable, test.value));
            add_need(op, any);
        }
        op.effects.push_back(fact(automaton, edge.target));
        for (const auto& set : edge.assign) op.effects.push_back(fact(base + set.variable, set.value));
        for (const Bound& b : edge.guard)
            if (b.i == 0) op.time = std::max<std::int64_t>(op.time, -(b.raw >> 1));
        const auto& deadline = game_.automata[automaton].invariants[edge.source];
        if (watches(game_, automaton)) {
            const auto restarts = [&](const Bound& b) {
                return std::find(edge.resets.begin(), edge.resets.end(), b.i) != edge.resets.end();
            };
            const bool ends = edge.source != edge.target || std::any_of(deadline.begin(), deadline.end(), restarts);
            if (!deadline.empty() && (chargers_.watches(automaton) ? !is_timed(automaton, edge.target) : ends))
                op.effects.push_back(fact(-1 - automaton, 0));
        } else if (!edge.controllable) {
            for (const Bound& b : deadline) op.time = std::max<std::int64_t>(op.time, b.raw >> 1);
        }
    }

    void add_operator(int a, const Edge& sender, int b, const Edge* receiver) {
        Operator op{sender.id, a, sender.controllable && (!receiver || receiver->controllable), 1, {}, {}};
        add_part(op, a, sender);
        if (receiver) add_part(op, b, *receiver);
        operators_.push_back(std::move(op));
    }

    const Game& game_;
    std::vector<int> robots_, watching_, turns_;
    std::vector<bool> visits_;

    int facts_ = 0;
    std::map<std::pair<int, int>, int> numbers_;  // of facts: an automaton or (behind them) a variable, and its value
    std::vector<int> about_, values_;             // per fact what it is about, and the value
    std::vector<std::vector<int>> met_by_;        // per fact the preconditions that it meets
    std::vector<int> preconditions_;              // per precondition the operator that has it
    std::vector<Operator> operators_;

    std::vector<std::int64_t> detours_;           // per fact what it costs besides the way

    std::map<int, Battery> batteries_;            // by robot
    Chargers chargers_;

    States looked_from_;                          // a state, the robot and `closed`
    std::deque<Look> looks_;                      // likewise
    const Look* now_ = nullptr;
    Answers losses_;
};

}  // namespace pursue
