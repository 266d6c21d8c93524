// Guess, then follow: a policy in which each robot does one duty after the other, and forward all plays by it.
//
// A state has a memory, the duty that each robot is at, so that it is not given up for another. The strategy has none: in
// a discrete state it holds what the policy says with any memory, at the clocks that plays with that memory come to.
// Whatever a play does next was followed from there, so each such play is one that was followed.
#pragma once

#include <memory>

#include "dispatch.hpp"
#include "excursions.hpp"
#include "limits.hpp"
#include "zone_graph.hpp"

namespace pursue {

inline constexpr std::size_t ALL = std::numeric_limits<std::size_t>::max();

template <class Z>
class Forward {
  public:
    using R = typename Z::raw_t;

    Forward(const Game& game, LimitMonitor& monitor, Joints& joints, Duties& duties, const Guess& guess)
        : game_(game), monitor_(monitor), guess_(guess), joints_(joints), decider_(decider(game, joints, duties, guess)),
          width_(game.automata.size() + game.variables.size()), start_(decider_->remembered(initial(game))),
          states_(width_ + start_.size()) {
        bounds_of_clocks();
    }

    // Whether the policy keeps from all that is to be avoided. False says nothing of the game, and where more than so many
    // zones were followed nothing of the policy.
    bool wins(std::size_t most) {
        const Discrete d = initial(game_);
        if (robots() == 0 || at_bad(game_, d)) return false;
        Z z = universe<Z>();
        if (game_.start.empty()) z = origin<Z>(game_.clocks);
        for (const Bound& b : game_.start)
            if (!constrain(z, b.i, b.j, static_cast<R>(b.raw))) return false;
        // Nothing is known of clocks that the game does not have: compared with others they would tell plays apart.
        for (int x = game_.clocks + 1; x < Z::size; ++x)
            for (int other = 0; other < Z::size; ++other)
                if (other != x) z.at(x, other) = z.at(other, x) = INF<R>;
        const Z start = z;
        const int first = spot(d, start_);
        if (!invariant(first, z) || !includes(z, start)) return false;
        enter(first, -1, z);
        while (!queue_.empty()) {
            monitor_.check(spots_.size(), queue_.size());
            const auto [k, zone] = queue_.begin()->second;
            queue_.erase(queue_.begin());
            const auto same = [&, here = zone](const auto& other) {
                return includes(here, other.second) && includes(other.second, here);
            };
            if (std::none_of(spots_[k].zones.begin(), spots_[k].zones.end(), same)) continue;  // a larger one took its place
            // A deadline that is missed a little later with each round: it would take very many.
            if (followed_ > std::min(most, 64 * spots_.size() + 1000) || !follow(k, zone)) return false;
        }
        return true;
    }

    // What to do in each discrete state that plays come to.
    std::map<Discrete, std::vector<Piece<Z>>> plan() {
        std::map<Discrete, std::vector<int>> same;
        for (std::size_t k = 0; k < spots_.size(); ++k)
            if (!spots_[k].zones.empty()) same[place(static_cast<int>(k))].push_back(static_cast<int>(k));
        std::map<Discrete, std::vector<Piece<Z>>> out;
        for (const auto& [d, numbers] : same) {
            Federation<Z> waits, acts;
            std::map<int, Federation<Z>> given;  // by joint move
            auto& pieces = out[d];
            for (const int k : numbers)
                for (const auto& [owner, zone] : spots_[k].zones) {
                    monitor_.look();
                    const Passage passed = pass(k, zone);
                    for (const auto& [act, joint] : passed.acts) {
                        absorb(given[joint], act);
                        absorb(acts, act);
                    }
                    for (const Z& wait : passed.waited) absorb(waits, wait);
                }
            for (const auto& [joint, zones] : given)
                for (const Z& zone : zones) pieces.push_back({zone, joint, 0});
            for (const Z& wait : reduced(minus(waits, acts))) pieces.push_back({wait, -1, 0});
        }
        return out;
    }

    std::size_t robots() const { return decider_->robots(); }
    bool alternates() const { return decider_->alternates(); }
    bool applies() const { return decider_->applies(); }
    const Tasks& tasks() const { return decider_->tasks(); }
    const Joint& joint(int k) const { return joints_[k]; }
    std::size_t followed() const { return followed_; }

  private:
    struct Spot {
        std::vector<Order> commands;
        std::vector<int> others;     // the environment's
        std::map<int, int> targets;  // where a joint move leads, -1: to what is to be avoided
        std::vector<Bound> limits;   // invariants
        std::vector<int> running;    // the clocks of open duties
        std::vector<std::pair<int, Z>> zones;  // at which plays enter, behind who moved last
        std::vector<wide_t> lower, upper;  // per clock the largest bounds that matter from here on
    };

    struct Passage {
        Federation<Z> waited;
        std::vector<std::pair<Z, int>> acts;
        Federation<Z> flights;       // of the commands, until they take effect
    };

    static std::unique_ptr<Decider> decider(const Game& game, Joints& joints, Duties& duties, const Guess& guess) {
        if (guess.trips != Trips::none) return std::make_unique<Excursions>(game, joints, duties, guess);
        return std::make_unique<Dispatch>(game, joints, duties, guess);
    }

    Discrete place(int k) const {
        Discrete d = states_[k];
        d.resize(width_);
        return d;
    }

    int spot(const Discrete& d, const std::vector<int>& memory) {
        Discrete key = d;
        key.insert(key.end(), memory.begin(), memory.end());
        const int k = states_.number(key);
        if (k < static_cast<int>(spots_.size())) return k;
        monitor_.admit(spots_.size(), queue_.size());
        Spot& s = spots_.emplace_back();
        std::vector<int> enabled;
        joints_.enabled(d, enabled);
        for (const int j : enabled)
            if (!joints_[j].controllable && !joints_[j].changes_nothing(d, game_)) s.others.push_back(j);
        s.commands = decider_->decided(d, enabled, memory);
        for (std::size_t a = 0; a < game_.automata.size(); ++a)
            for (const Bound& b : game_.automata[a].invariants[d[a]]) {
                s.limits.push_back(b);
                if (watches(game_, static_cast<int>(a))) s.running.push_back(b.i);
            }
        s.lower.assign(Z::size, -1);
        s.upper.assign(Z::size, -1);
        for (std::size_t a = 0; a < game_.automata.size(); ++a)
            for (int x = 1; x <= game_.clocks; ++x) {
                s.lower[x] = std::max(s.lower[x], lower_[a][d[a]][x]);
                s.upper[x] = std::max(s.upper[x], upper_[a][d[a]][x]);
            }
        return k;
    }

    bool invariant(int k, Z& z) const {
        for (const Bound& b : spots_[k].limits)
            if (!constrain(z, b.i, b.j, static_cast<R>(b.raw))) return false;
        return true;
    }

    static bool guard(const Joint& joint, Z& z) {
        for (const Bound& b : joint.guard)
            if (!constrain(z, b.i, b.j, static_cast<R>(b.raw))) return false;
        return true;
    }

    static bool given(const Order& order, const Joint& joint, Z& z) {
        const Bound& since = order.since;
        return guard(joint, z) && (since.i == since.j || constrain(z, since.i, since.j, static_cast<R>(since.raw)));
    }

    // Time from an entry: what is waited in, where which command is given, and where it is on its way.
    Passage pass(int k, const Z& zone) {
        const Spot& s = spots_[k];
        Passage out;
        Federation<Z> rest{zone};
        for (const Order& order : s.commands) {
            Z act = zone;
            if (!given(order, joints_[order.joint], act)) continue;
            out.acts.emplace_back(act, order.joint);
            rest = minus(rest, act);
        }
        for (const Z& piece : rest) {
            spend(1);
            Z future = piece;
            up(future);
            invariant(k, future);
            Federation<Z> waited{future};
            std::vector<std::pair<Z, int>> entrances;
            for (const Order& order : s.commands) {
                const int c = order.joint;
                Z common = future;
                if (!given(order, joints_[c], common)) continue;
                Z later = common;
                up(later);
                waited = minus(waited, later);
                std::vector<Bound> bounds = joints_[c].guard;
                bounds.push_back(order.since);
                for (const Bound& b : bounds) {
                    // At once; behind a strict bound there is no first instant: within the next unit of scaled time.
                    const wide_t soon = -(b.raw >> 1) + (b.raw & 1 ? 0 : 1);
                    Z entrance = common;
                    if (b.i == 0 && b.j > 0 && constrain(entrance, b.j, 0, static_cast<R>(2 * soon + 1))) entrances.emplace_back(entrance, c);
                }
            }
            // Whatever comes first takes effect soon.
            for (const Z& wait : waited) {
                Z met = wait;
                up_within(met, game_.delta + 1);
                for (const auto& [entrance, c] : entrances)
                    if (Z act = entrance; intersect(act, met)) out.acts.emplace_back(act, c);
            }
            append(out.waited, waited);
        }
        for (const auto& [act, joint] : out.acts) {
            Z flight = act;
            up_within(flight, game_.delta);
            invariant(k, flight);
            out.flights.push_back(flight);
        }
        return out;
    }

    // Follows all that may happen from an entry. False: something that is to be avoided, or time cannot go on.
    bool follow(int k, const Z& zone) {
        ++followed_;
        const Passage passed = pass(k, zone);
        const Discrete d = place(k);
        Federation<Z> active;
        for (const Federation<Z>* some : {&passed.waited, &passed.flights})
            for (const Z& z : *some) absorb(active, z);
        for (const Z& z : active)
            if (!goes_on(k, d, z)) return false;
        const std::vector<int> others = spots_[k].others;
        for (const int j : others)
            for (const Z& z : active)
                if (!step(k, d, j, z)) return false;
        for (std::size_t n = 0; n < passed.acts.size(); ++n) {
            Z flight = passed.flights[n];
            const int c = passed.acts[n].second;
            if (!guard(joints_[c], flight) || !includes(flight, passed.flights[n])) return false;  // it may come too late
            if (!step(k, d, c, flight)) return false;
        }
        return true;
    }

    // Whether each who is at the bound of an invariant can move by himself.
    bool goes_on(int k, const Discrete& d, const Z& active) {
        for (int a = 0; a < static_cast<int>(game_.automata.size()); ++a)
            for (const Bound& b : game_.automata[a].invariants[d[a]]) {
                Z last = active;
                if (!(b.raw & 1) || !constrain(last, b.j, b.i, static_cast<R>(2 - b.raw))) continue;
                const bool matters = std::find(game_.unseen.begin(), game_.unseen.end(), a) == game_.unseen.end();
                Federation<Z> stuck{last};
                for (const int j : spots_[k].others) {
                    const Joint& joint = joints_[j];
                    if (joint.owner != a || (matters && joint.is_unseen(d, game_))) continue;
                    Z moved = last;
                    if (guard(joint, moved)) stuck = minus(stuck, moved);
                }
                if (!stuck.empty()) return false;
            }
        return true;
    }

    bool step(int k, const Discrete& d, int j, Z z) {
        spend(1);
        const Joint& joint = joints_[j];
        if (!guard(joint, z)) return true;
        for (const int x : joint.resets) reset(z, x);
        const auto [known, fresh] = spots_[k].targets.try_emplace(j, -1);
        if (fresh) known->second = target(k, d, joint);
        const int to = known->second;
        if (to < 0) return false;
        if (invariant(to, z)) enter(to, joint.owner, z);
        return true;
    }

    // The state that a joint move leads to, -1: it is to be avoided.
    int target(int k, const Discrete& d, const Joint& joint) {
        const Discrete target = joint.target(d);
        if (at_bad(game_, target)) return -1;
        const Discrete key = states_[k];
        std::vector<int> memory(key.begin() + static_cast<std::ptrdiff_t>(width_), key.end());
        decider_->remember(d, joint, memory);
        return spot(target, memory);
    }

    // Of zones that become one, all are entered by moves of the same automaton: its pause has just begun.
    void enter(int k, int owner, Z z) {
        Spot& s = spots_[k];
        extrapolate(s, z);
        invariant(k, z);
        if (!guess_.apart) owner = -1;
        std::size_t same = 0;
        for (const auto& [other, zone] : s.zones) {
            if (includes(zone, z)) return;
            same += other == owner;
        }
        if (same >= guess_.zones) {
            for (const auto& [other, zone] : s.zones)
                if (other == owner) z = hull(z, zone);
            extrapolate(s, z);
            invariant(k, z);
        }
        const auto covered = [&](const auto& other) { return includes(z, other.second); };
        s.zones.erase(std::remove_if(s.zones.begin(), s.zones.end(), covered), s.zones.end());
        s.zones.emplace_back(owner, z);
        queue_.emplace(rank(k, z), std::pair(k, z));
    }

    // What comes first. One robot: few open duties, then young ones, as what comes before is complete then. Several are in
    // each other's way now and then, and come to a state at many times: first in, first out. Where they take turns each trip
    // begins as others did: what was met first.
    std::pair<int, wide_t> rank(int k, const Z& z) const {
        if (guess_.trips != Trips::none) return {0, k};
        if (robots() > 1) return {0, 0};
        const Spot& s = spots_[k];
        wide_t age = 0;
        for (const int x : s.running)
            if (z.at(x, 0) < INF<R>) age = std::max<wide_t>(age, z.at(x, 0));
        return {static_cast<int>(s.running.size()), age};
    }

    // Extra+_LU (Behrmann et al. 2006): what is beyond all bounds that matter is forgotten. That only adds plays.
    static void extrapolate(const Spot& s, Z& z) {
        const Z old = z;
        bool changed = false;
        for (int i = 0; i < Z::size; ++i)
            for (int j = 0; j < Z::size; ++j) {
                R& b = z.at(i, j);
                if (i == j || b >= INF<R>) continue;
                const bool low = i > 0 && (b > 2 * s.lower[i] + 1 || -old.at(0, i) > 2 * s.lower[i]);
                const bool high = j > 0 && -old.at(0, j) > 2 * s.upper[j];
                if (low || (high && i > 0)) b = INF<R>;
                else if (high) b = static_cast<R>(s.upper[j] < 0 ? LE_ZERO : -2 * s.upper[j]);
                else continue;
                changed = true;
            }
        if (changed) close(z);
    }

    // Per automaton, location and clock the largest bounds that matter before the clock is reset, -1: none. Lower ones: what
    // has to have passed before something can happen; upper ones: until when it can.
    void bounds_of_clocks() {
        for (std::size_t a = 0; a < game_.automata.size(); ++a) {
            const Automaton& automaton = game_.automata[a];
            const std::size_t places = automaton.invariants.size();
            for (Table* table : {&lower_, &upper_}) table->emplace_back(places, std::vector<wide_t>(game_.clocks + 1, -1));
            const auto note = [&](Table& table, int location, int x, wide_t bound) {
                table[a][location][x] = std::max(table[a][location][x], bound);
            };
            const bool duty = watches(game_, static_cast<int>(a));
            const bool waits = duty && decider_->is_patrol(static_cast<int>(a));
            for (int l = 0; l < static_cast<int>(places); ++l)
                for (const Bound& b : automaton.invariants[l]) {
                    if (duty) note(lower_, l, b.i, b.raw >> 1);
                    if (!duty || waits || decider_->is_charging(static_cast<int>(a), l)) note(upper_, l, b.i, b.raw >> 1);
                }
            for (const Edge& edge : automaton.edges)
                for (const Bound& b : edge.guard) {
                    if (b.i) note(upper_, edge.source, b.i, b.raw >> 1);
                    if (b.j) note(lower_, edge.source, b.j, -(b.raw >> 1));
                    if (b.j && edge.controllable) note(upper_, edge.source, b.j, -(b.raw >> 1) + (b.raw & 1 ? 0 : 1));
                }
            for (bool changed = true; changed;) {
                changed = false;
                for (const Edge& edge : automaton.edges)
                    for (int x = 1; x <= game_.clocks; ++x) {
                        if (std::find(edge.resets.begin(), edge.resets.end(), x) != edge.resets.end()) continue;
                        for (Table* table : {&lower_, &upper_}) {
                            if ((*table)[a][edge.target][x] <= (*table)[a][edge.source][x]) continue;
                            (*table)[a][edge.source][x] = (*table)[a][edge.target][x];
                            changed = true;
                        }
                    }
            }
        }
    }

    using Table = std::vector<std::vector<std::vector<wide_t>>>;

    const Game& game_;
    LimitMonitor& monitor_;
    const Guess guess_;
    Joints& joints_;
    const std::unique_ptr<Decider> decider_;
    const std::size_t width_;
    const std::vector<int> start_;  // what is remembered at first
    States states_;
    std::deque<Spot> spots_;
    std::multimap<std::pair<int, wide_t>, std::pair<int, Z>> queue_;  // by `rank`
    Table lower_, upper_;
    std::size_t followed_ = 0;
};

}  // namespace pursue
