// The game: forward exploration of discrete states (one hull of zones each), then a fixpoint on federations.
//
// Rules and names (W, L, F, Stuck, Exp, ownU, cPre, uPre, Predt) are those of the design page on the game; a reaction
// delay keeps a command usable only where it stays right, and the environment harmless, for the whole delay.
#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <map>
#include <string>

#include "federation.hpp"
#include "relaxed.hpp"

namespace pursue {

struct Limit : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct Limits {
    double seconds = 0;                     // 0: none
    std::size_t states = 0;                 // discrete states, 0: none
    std::function<void()> poll = [] {};     // called now and then; may throw (Ctrl-C)
};

template <int N>
class Solver {
  public:
    struct Action {
        Dbm<N> zone;
        int move;  // index into Node::moves, -1: wait
        int rank;  // reach: every step from here leads to lower ranks
    };

    struct Node {
        Discrete d;
        Dbm<N> hull{};
        std::vector<raw_t> max;      // the largest constants that matter here
        bool reached = false, full = false, queued = false;
        std::vector<Move> moves;
        std::vector<int> targets;    // node per move, -1: not followed
        std::vector<int> parents;
        Federation<N> set;           // reach: winning; safety: losing
        std::vector<Action> plan;    // reach: in the order in which the points were won
    };

    Solver(const Game& game, const Limits& limits)
        : game_(game), limits_(limits), start_(std::chrono::steady_clock::now()), planner_(game, wish(game)), horizon_(game) {}

    bool run() {
        initial_ = node(first());
        Node& n = nodes_[initial_];
        n.reached = invariant(n.d, n.hull = origin<N>(game_.clocks));
        if (!n.reached) return false;
        elapse(n, n.hull);
        expand(initial_, game_.kind == Kind::safety);
        explore();
        if (game_.kind == Kind::safety) return !fixpoint();
        while (!fixpoint())
            if (!open_lost()) return false;
        return true;
    }

    // What to do in each state of the closed loop's universe, zones disjoint.
    std::vector<Action> plan(const Node& n) const { return game_.kind == Kind::safety ? safe_plan(n) : n.plan; }

    const std::deque<Node>& nodes() const { return nodes_; }
    std::size_t evaluations() const { return evaluations_; }

  private:
    // --- discrete states -------------------------------------------------------------------------------------------

    // What the controller wishes for when it may choose: the goal, or to have the duty of the safety objective behind it.
    static Place wish(const Game& game) {
        if (game.kind != Kind::safety) return game.goal;
        return {game.bad.automaton, game.automata[game.bad.automaton].initial};
    }

    Discrete first() const {
        Discrete d;
        for (const auto& a : game_.automata) d.push_back(a.initial);
        d.insert(d.end(), game_.variables.begin(), game_.variables.end());
        return d;
    }

    bool won(const Discrete& d) const { return game_.kind != Kind::safety && at(d, game_.goal); }
    bool lost(const Discrete& d) const { return !won(d) && at(d, game_.bad); }

    int node(const Discrete& d) {
        const auto [it, fresh] = index_.emplace(d, static_cast<int>(nodes_.size()));
        if (fresh) {
            check();
            nodes_.emplace_back();
            nodes_.back().d = d;
            nodes_.back().max = horizon_.at(d, N);
        }
        return it->second;
    }

    void check() {
        if (++checks_ % 256) return;
        limits_.poll();
        if (limits_.states && nodes_.size() >= limits_.states) throw Limit("states");
        const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start_;
        if (limits_.seconds > 0 && spent.count() > limits_.seconds) throw Limit("seconds");
    }

    bool invariant(const Discrete& d, Dbm<N>& z) const {
        for (std::size_t a = 0; a < game_.automata.size(); ++a)
            for (const Bound& b : game_.automata[a].invariants[d[a]])
                if (!constrain(z, b.i, b.j, b.raw)) return false;
        return true;
    }

    void elapse(const Node& n, Dbm<N>& z) const {
        up(z);
        invariant(n.d, z);
        forget(n, z);
    }

    void forget(const Node& n, Dbm<N>& z) const {
        extrapolate(z, n.max);
        invariant(n.d, z);
    }

    // Decides which moves of a state are followed: all, or every uncontrollable one and one controllable one.
    void expand(int k, bool full) {
        Node& n = nodes_[k];
        if (n.full || won(n.d) || lost(n.d)) return;
        if (n.moves.empty()) {
            n.moves = joint_moves(game_, n.d);
            n.targets.assign(n.moves.size(), -1);
        }
        n.full = full;
        int chosen = -1;
        if (!full) {
            const std::vector<int> edges = planner_.first_edges(n.d);
            for (std::size_t m = 0; m < n.moves.size() && chosen < 0; ++m)
                if (n.moves[m].controllable && !edges.empty() && n.moves[m].edges[0] == edges[0]) chosen = static_cast<int>(m);
        }
        for (std::size_t m = 0; m < nodes_[k].moves.size(); ++m) {
            if (nodes_[k].targets[m] >= 0) continue;
            if (!full && nodes_[k].moves[m].controllable && static_cast<int>(m) != chosen) continue;
            const int target = node(nodes_[k].moves[m].target);
            nodes_[k].targets[m] = target;
            nodes_[target].parents.push_back(k);
        }
        touched_.push_back(k);
    }

    // Grows the hulls until every followed move of every reached point leads into a hull.
    void explore() {
        while (!touched_.empty()) {
            check();
            const int k = touched_.front();
            touched_.pop_front();
            wake(k);
            for (std::size_t m = 0; m < nodes_[k].moves.size(); ++m) {
                const int t = nodes_[k].targets[m];
                if (t < 0) continue;
                Dbm<N> z = nodes_[k].hull;
                const Move& move = nodes_[k].moves[m];
                if (!guard(move, z)) continue;
                for (int x : move.resets) reset(z, x);
                Node& target = nodes_[t];
                if (!invariant(target.d, z)) continue;
                elapse(target, z);
                if (target.reached && includes(target.hull, z)) continue;
                if (target.reached) {
                    z = hull(target.hull, z);
                    forget(target, z);
                }
                const bool fresh = !target.reached;
                target.hull = z;
                target.reached = true;
                if (fresh) expand(t, game_.kind == Kind::safety);
                else touched_.push_back(t);
                if (fresh && nodes_[t].moves.empty()) wake(t);
                for (int p : nodes_[t].parents) wake(p);
            }
        }
    }

    // After a loss with few moves: states that are not won get all of theirs. False when all of them had them.
    bool open_lost() {
        const std::size_t count = nodes_.size();
        for (std::size_t k = 0; k < count; ++k)
            if (nodes_[k].reached && !nodes_[k].full && !contains(nodes_[k].set, nodes_[k].hull))
                expand(static_cast<int>(k), true);
        const bool more = !touched_.empty();
        explore();
        return more;
    }

    // --- symbolic steps --------------------------------------------------------------------------------------------

    static bool guard(const Move& move, Dbm<N>& z) {
        for (const Bound& b : move.guard)
            if (!constrain(z, b.i, b.j, b.raw)) return false;
        return true;
    }

    // The points of n from which the move leads into `zones` of its target.
    Federation<N> before(const Node& n, const Move& move, const Node& target, const Federation<N>& zones) const {
        Federation<N> out;
        for (auto z : zones) {
            if (!invariant(target.d, z)) continue;
            bool some = true;
            for (int x : move.resets) some = some && constrain(z, x, 0, LE_ZERO);
            if (!some) continue;
            for (int x : move.resets) free_clock(z, x);
            if (guard(move, z) && intersect(z, n.hull)) out.push_back(z);
        }
        return out;
    }

    Federation<N> harm(const Node& n, const std::function<Federation<N>(const Node&)>& outside) const {
        Federation<N> out;
        for (std::size_t m = 0; m < n.moves.size(); ++m)
            if (!n.moves[m].controllable && n.targets[m] >= 0) {
                const Node& target = nodes_[n.targets[m]];
                if (target.reached) append(out, before(n, n.moves[m], target, outside(target)));
            }
        return reduced(out);
    }

    // Per controllable move the points at which it may be commanded: right now and for the whole reaction delay.
    std::vector<std::pair<int, Federation<N>>> commands(const Node& n, const Federation<N>& harmful,
                                                        const std::function<Federation<N>(const Node&)>& inside) const {
        std::vector<std::pair<int, Federation<N>>> out;
        for (std::size_t m = 0; m < n.moves.size(); ++m) {
            if (!n.moves[m].controllable || n.targets[m] < 0) continue;
            const Node& target = nodes_[n.targets[m]];
            if (!target.reached) continue;
            Federation<N> good = before(n, n.moves[m], target, inside(target));
            if (game_.delta > 0 && !good.empty()) good = lasting(reduced(minus(good, harmful)), game_.delta);
            if (!good.empty()) out.emplace_back(static_cast<int>(m), reduced(good));
        }
        return out;
    }

    // The points where automaton a is at the bound of its invariant.
    Federation<N> at_bound(const Node& n, int a) const {
        Federation<N> out;
        for (const Bound& b : game_.automata[a].invariants[n.d[a]]) {
            Dbm<N> z = n.hull;
            if ((b.raw & 1) && constrain(z, b.j, b.i, 1 - b.raw + 1)) out.push_back(z);
        }
        return out;
    }

    // The points where automaton a can make an uncontrollable move of its own.
    Federation<N> own_moves(const Node& n, int a) const {
        Federation<N> out;
        for (std::size_t m = 0; m < n.moves.size(); ++m)
            if (n.moves[m].owner == a && !n.moves[m].controllable && n.targets[m] >= 0) {
                const Node& target = nodes_[n.targets[m]];
                if (target.reached) append(out, before(n, n.moves[m], target, {target.hull}));
            }
        return out;
    }

    // --- fixpoints -------------------------------------------------------------------------------------------------

    void wake(int k) {
        if (nodes_[k].queued) return;
        nodes_[k].queued = true;
        waiting_.push_back(k);
    }

    // Returns whether the initial position came into its state's set (won, or lost in a safety game).
    bool fixpoint() {
        const Dbm<N> zero = origin<N>(game_.clocks);
        while (!waiting_.empty()) {
            check();
            const int k = waiting_.front();
            waiting_.pop_front();
            nodes_[k].queued = false;
            if (!nodes_[k].reached) continue;
            ++evaluations_;
            limits_.poll();
            if (!(game_.kind == Kind::safety ? lose_more(nodes_[k]) : win_more(nodes_[k]))) continue;
            for (int p : nodes_[k].parents) wake(p);
            if (k == initial_ && contains(nodes_[k].set, zero)) return true;
        }
        return contains(nodes_[initial_].set, zero);
    }

    static Federation<N> outside_of(const Node& n) { return minus(Federation<N>{n.hull}, n.set); }

    bool grow(Node& n, const Federation<N>& fresh) {
        append(n.set, fresh);
        n.set = reduced(n.set);
        return true;
    }

    bool win_more(Node& n) {
        if (lost(n.d)) return false;
        if (won(n.d)) {
            if (contains(n.set, n.hull)) return false;
            n.set = {n.hull};
            return true;
        }
        const Federation<N> missing = reduced(outside_of(n));
        if (missing.empty()) return false;
        const Federation<N> harmful = harm(n, outside_of);
        const auto usable = commands(n, harmful, [](const Node& t) { return t.set; });
        Federation<N> good = n.set;
        for (const auto& [move, zones] : usable) append(good, zones);
        for (int a = 0; a < static_cast<int>(game_.automata.size()); ++a) {
            const Federation<N> bound = at_bound(n, a);
            if (!bound.empty()) append(good, minus(intersection(own_moves(n, a), bound), harmful));
        }
        Federation<N> fresh = reduced(intersection(predt(good, harmful), missing));
        if (fresh.empty()) return false;
        Federation<N> rest = fresh;
        for (const auto& [move, zones] : usable) {
            for (const auto& z : reduced(intersection(rest, minus(zones, harmful)))) n.plan.push_back({z, move, rank_});
            rest = minus(rest, minus(zones, harmful));
        }
        for (const auto& z : reduced(rest)) n.plan.push_back({z, -1, rank_});
        ++rank_;
        return grow(n, fresh);
    }

    struct SafetyView {
        Federation<N> harmful;  // uPre(X)
        Federation<N> duty;     // from here the controller has to act some time: the past of E and of Stuck without escapes
        std::vector<std::pair<int, Federation<N>>> usable;
        Federation<N> losing;
    };

    static Federation<N> past(const Node& n, Federation<N> zones) {
        zones = reduced(zones);
        for (auto& z : zones) down(z);
        return reduced(intersection(reduced(zones), n.hull));
    }

    SafetyView look(const Node& n, bool with_duty) const {
        SafetyView view;
        view.harmful = harm(n, [](const Node& t) { return t.set; });
        view.usable = commands(n, view.harmful, outside_of);
        Federation<N> escapes;
        for (const auto& [move, zones] : view.usable) append(escapes, zones);
        escapes = reduced(escapes);
        Federation<N> evil = n.set;
        append(evil, view.harmful);
        if (with_duty) view.duty = evil;
        for (int a = 0; a < static_cast<int>(game_.automata.size()); ++a) {
            const Federation<N> obliged = minus(at_bound(n, a), own_moves(n, a));
            if (with_duty) append(view.duty, obliged);
            append(evil, minus(obliged, escapes));
        }
        evil = reduced(evil);
        if (with_duty) view.duty = past(n, view.duty);
        else view.losing = minus(past(n, evil), predt(minus(escapes, evil), evil));
        return view;
    }

    bool lose_more(Node& n) {
        if (lost(n.d)) {
            if (contains(n.set, n.hull)) return false;
            n.set = {n.hull};
            return true;
        }
        const Federation<N> fresh = reduced(minus(look(n, false).losing, n.set));
        return !fresh.empty() && grow(n, fresh);
    }

    // Safe points: where waiting for ever is safe, wait; else the command that a relaxed plan likes, else any safe one.
    std::vector<Action> safe_plan(const Node& n) const {
        std::vector<Action> out;
        if (lost(n.d)) return out;
        Federation<N> safe = reduced(outside_of(n));
        if (safe.empty()) return out;
        SafetyView view = look(n, true);
        const std::vector<int> liked = planner_.first_edges(n.d);
        const auto rank = [&](int move) {
            return std::find(liked.begin(), liked.end(), n.moves[move].edges[0]) - liked.begin();
        };
        std::stable_sort(view.usable.begin(), view.usable.end(),
                         [&](const auto& a, const auto& b) { return rank(a.first) < rank(b.first); });
        Federation<N> urgent = reduced(intersection(view.duty, safe));
        for (const auto& [move, zones] : view.usable) {
            const Federation<N> here = minus(zones, view.harmful);
            for (const auto& z : reduced(intersection(urgent, here))) out.push_back({z, move, 0});
            urgent = minus(urgent, here);
            safe = minus(safe, intersection(view.duty, here));
        }
        for (const auto& z : reduced(safe)) out.push_back({z, -1, 0});
        return out;
    }

    const Game& game_;
    const Limits& limits_;
    std::chrono::steady_clock::time_point start_;
    RelaxedPlanner planner_;
    Horizon horizon_;
    std::deque<Node> nodes_;
    std::map<Discrete, int> index_;
    std::deque<int> touched_, waiting_;
    int initial_ = 0, rank_ = 1;
    std::size_t evaluations_ = 0, checks_ = 0;
};

}  // namespace pursue
