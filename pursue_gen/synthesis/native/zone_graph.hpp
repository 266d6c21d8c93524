// The zone graph of a game: discrete states with one hull of zones each, the moves that are followed, symbolic steps.
#pragma once

#include <limits>

#include "zones/native/federation.hpp"
#include "limits.hpp"
#include "policy.hpp"

namespace pursue {

template <class Z>
struct Piece {
    Z zone;
    int joint;  // -1: wait
    int rank;   // reach: every step from here leads to lower ranks
};

struct Transition {
    int joint, target;
    bool unseen;  // it changes at most what cannot matter: it obliges nobody
};

// Of whose moves a search follows only a few at first; it opens the rest later.
enum class Restricted { controllable, uncontrollable, none };

template <class Z>
struct Node {
    Z hull{};
    bool won = false, lost = false;           // by its locations alone
    bool reached = false, full = false, queued = false, scheduled = false;
    std::int64_t when = 0;                    // if it is scheduled: how soon
    std::vector<std::int64_t> busy;           // reach, in the order of time: what each agent has still to do
    int deferred = 0;                         // automata that stop time here until the environment moves them
    std::vector<wide_t> max;                  // the largest constants that matter here
    std::vector<std::pair<int, Bound>> limits;  // invariants, with the automata that have them
    std::vector<Transition> transitions;      // the moves that are followed
    std::vector<Transition> unfollowed;       // uncontrollable moves that are not, but oblige the environment at a bound
    std::vector<int> parents;
    Federation<Z> rest;                       // of the hull, what is not (yet) won in a reach game, or lost in a safety game
    Federation<Z> done, fresh;                // the other points: gathered, and not gathered yet
    Federation<Z> bounds;                     // what comes of automata at their bounds, see `at_bounds`
    std::uint64_t bounds_work = 0;            // what it takes to find that out
    bool bounds_known = false;                // since hull and moves changed
    bool coarse = false;                      // reach: more is won than `rest` says
};

template <class Z>
class ZoneGraph {
  public:
    using R = typename Z::raw_t;

    ZoneGraph(const Game& game, LimitMonitor& monitor, Restricted restricted)
        : game_(game), restricted_(restricted), monitor_(monitor), policy_(game), max_constants_(game), joints_(game),
          states_(game.automata.size() + game.variables.size()) {}

    const std::deque<Node<Z>>& nodes() const { return nodes_; }
    Discrete state(int k) const { return states_[k]; }
    const Joint& joint(int k) const { return joints_[k]; }
    std::size_t symbolic_states() const { return symbolic_states_; }  // zones whose successors were computed
    void check_limits() { monitor_.check(nodes_.size(), queue_.size()); }

  protected:
    // --- discrete states -------------------------------------------------------------------------------------------

    // The clocks at the start. Throws where there are none.
    Z start_zone() const {
        if (game_.start.empty()) return origin<Z>(game_.clocks);
        Z z = universe<Z>();
        for (const Bound& b : game_.start)
            if (!within(b, z)) throw std::invalid_argument("no clock values satisfy the bounds at the start");
        return z;
    }

    // Enters the initial state; false: its invariants do not hold for all clocks at the start.
    bool enter_start() {
        Node<Z>& n = nodes_[node(initial(game_))];
        const Z start = n.hull = start_zone();
        n.reached = invariant(n, n.hull) && includes(n.hull, start);
        if (!n.reached) return false;
        elapse(n, n.hull);
        n.rest = {n.hull};
        enqueue(0);
        expand(0, false);
        return true;
    }

    int node(const Discrete& d) {
        const int k = states_.number(d);
        if (k < static_cast<int>(nodes_.size())) return k;
        monitor_.admit(nodes_.size(), queue_.size());
        Node<Z>& n = nodes_.emplace_back();
        n.won = game_.kind != Kind::safety && at_goal(game_, d);
        n.lost = !n.won && at_bad(game_, d);
        n.max = max_constants_.at(d, Z::size);
        for (std::size_t a = 0; a < game_.automata.size(); ++a) {
            const auto& bounds = game_.automata[a].invariants[d[a]];
            for (const Bound& b : bounds) n.limits.emplace_back(static_cast<int>(a), b);
            n.deferred += !bounds.empty() && policy_.is_deferred(static_cast<int>(a), d[a]);
        }
        return k;
    }

    static bool within(const Bound& b, Z& z) { return constrain(z, b.i, b.j, static_cast<R>(b.raw)); }

    static bool invariant(const Node<Z>& n, Z& z) {
        for (const auto& [automaton, bound] : n.limits)
            if (!within(bound, z)) return false;
        return true;
    }

    static void elapse(const Node<Z>& n, Z& z) {
        up(z);
        invariant(n, z);
        extrapolate_within(n, z);
    }

    static void extrapolate_within(const Node<Z>& n, Z& z) {
        extrapolate(z, n.max);
        invariant(n, z);
    }

    // Follows the moves of a state that the policy prefers, or all.
    void expand(int k, bool full) {
        if (nodes_[k].full || nodes_[k].won || nodes_[k].lost) return;
        nodes_[k].full = full;
        nodes_[k].bounds_known = false;
        nodes_[k].unfollowed.clear();
        const Discrete d = states_[k];
        joints_.enabled(d, enabled_);
        // What the controller does first is a plan, which takes longer than all else here.
        const std::vector<int> preferred = full || !chooses() ? std::vector<int>{} : preferred_edges(d);
        bool chosen = false;
        for (const int j : enabled_) {
            const Joint& joint = joints_[j];
            if (joint.changes_nothing(d, game_)) continue;
            const bool unseen = joint.is_unseen(d, game_);
            if (full || follows(d, joint, preferred, chosen)) follow(k, {j, node(joint.target(d)), unseen});
            else if (!joint.controllable) nodes_[k].unfollowed.push_back({j, node(joint.target(d)), unseen});
        }
        enqueue(k);
    }

    // Reach: whether the controller can do anything where these moves are enabled.
    bool chooses() const {
        return game_.kind == Kind::safety || std::any_of(enabled_.begin(), enabled_.end(), [&](int j) {
                   return joints_[j].controllable;
               });
    }

    std::vector<int> preferred_edges(const Discrete& d) const {
        if (restricted_ == Restricted::none) return {};
        if (game_.kind != Kind::safety) return policy_.towards_goal(d);
        return restricted_ == Restricted::controllable ? policy_.towards_subgoals(d) : policy_.towards_loss(d);
    }

    // Reach: one controllable move; safety: those that the restricted side prefers.
    bool follows(const Discrete& d, const Joint& joint, const std::vector<int>& preferred, bool& chosen) const {
        const bool few_own = restricted_ == Restricted::controllable;
        if (restricted_ == Restricted::none || joint.controllable != few_own) return true;
        if (game_.kind == Kind::safety && few_own) return policy_.serves_subgoals(d, joint, preferred);
        const bool is_preferred = std::find(preferred.begin(), preferred.end(), joint.edges[0]) != preferred.end();
        if (!few_own) return is_preferred || policy_.ends(d, joint);
        const bool first = is_preferred && !chosen;
        chosen = chosen || first;
        return first;
    }

    void follow(int k, const Transition& move) {
        for (const Transition& transition : nodes_[k].transitions)
            if (transition.joint == move.joint) return;
        nodes_[k].transitions.push_back(move);
        std::vector<int>& parents = nodes_[move.target].parents;
        if (parents.empty() || parents.back() != k) parents.push_back(k);
    }

    void enqueue(int k) {
        if (nodes_[k].queued) return;
        nodes_[k].queued = true;
        queue_.push_back(k);
    }

    // Grows the hulls until every followed move of every reached point leads into a hull, or there are `most` symbolic
    // states. Returns the states that changed.
    std::vector<int> explore(std::size_t most = std::numeric_limits<std::size_t>::max()) {
        std::vector<int> changed;
        while (!queue_.empty() && symbolic_states_ < most) {
            monitor_.check(nodes_.size(), queue_.size());
            const int k = queue_.front();
            queue_.pop_front();
            nodes_[k].queued = false;
            changed.push_back(k);
            ++symbolic_states_;
            for (std::size_t t = 0; t < nodes_[k].transitions.size(); ++t)
                propagate(nodes_[k].hull, nodes_[k].transitions[t]);
        }
        std::sort(changed.begin(), changed.end());
        changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
        for (int k : changed) nodes_[k].rest = minus(Federation<Z>{nodes_[k].hull}, gathered(nodes_[k]));
        return changed;
    }

    // Where the move leads from z; false: nowhere.
    static bool step(const Joint& joint, const Node<Z>& target, Z& z) {
        spend(1);
        if (!guard(joint, z)) return false;
        for (int x : joint.resets) reset(z, x);
        if (!invariant(target, z)) return false;
        extrapolate_within(target, z);
        return true;
    }

    // The same, and what time makes of it.
    static bool take(const Joint& joint, const Node<Z>& target, Z& z) {
        spend(1);
        if (!guard(joint, z)) return false;
        for (int x : joint.resets) reset(z, x);
        if (!invariant(target, z)) return false;
        elapse(target, z);
        return true;
    }

    void propagate(Z z, const Transition& transition) {
        Node<Z>& target = nodes_[transition.target];
        if (!take(joints_[transition.joint], target, z)) return;
        if (target.reached) {
            if (includes(target.hull, z)) return;
            z = hull(target.hull, z);
            extrapolate_within(target, z);
        }
        const bool fresh = !target.reached;
        gathered(target);  // while the rest still is what this hull leaves
        target.hull = z;
        target.bounds_known = false;
        target.reached = true;
        enqueue(transition.target);
        if (fresh) expand(transition.target, all_);
    }

    // --- sets -------------------------------------------------------------------------------------------------------

    // The points of a state that are decided, in few zones: gathered on demand, which is seldom. Requires that they and
    // the rest make up the hull.
    static const Federation<Z>& gathered(Node<Z>& n) {
        if (n.fresh.empty()) return n.done;
        // A set in many zones is often the complement of a complement in fewer.
        const bool turned = n.rest.size() <= n.done.size() + n.fresh.size();
        if (turned && n.rest.size() <= 8) {
            n.done = reduced(minus(Federation<Z>{n.hull}, n.rest));
        } else {
            for (const Z& z : n.fresh) absorb(n.done, z);
            if (turned && n.done.size() > n.rest.size()) {
                Federation<Z> again = reduced(minus(Federation<Z>{n.hull}, n.rest));
                if (again.size() < n.done.size()) n.done = std::move(again);
            }
        }
        n.fresh.clear();
        return n.done;
    }

    // --- symbolic steps --------------------------------------------------------------------------------------------

    static bool guard(const Joint& joint, Z& z) {
        for (const Bound& b : joint.guard)
            if (!within(b, z)) return false;
        return true;
    }

    // Appends the points of n from which the move leads into `zones` of its target.
    static void before(const Node<Z>& n, const Joint& joint, const Federation<Z>& zones, Federation<Z>& out) {
        for (const Z& zone : zones) {
            const auto late = [&](int x) { return zone.at(0, x) < LE_ZERO; };
            if (std::any_of(joint.resets.begin(), joint.resets.end(), late)) continue;
            Z z = zone;
            for (int x : joint.resets) constrain(z, x, 0, LE_ZERO);
            for (int x : joint.resets) free_clock(z, x);
            if (guard(joint, z) && intersect(z, n.hull)) out.push_back(z);
        }
    }

    // For each automaton with bounds what `found` makes of it, together. It is found out once as long as hull and moves
    // stay as they are, and its work counts each time.
    template <class F>
    static const Federation<Z>& at_bounds(Node<Z>& n, F found) {
        if (n.bounds_known) {
            spend(n.bounds_work);
            return n.bounds;
        }
        const auto before = effort.zones;
        n.bounds.clear();
        int last = -1;
        for (const auto& [a, bound] : n.limits) {
            if (a != last) append(n.bounds, found(a));
            last = a;
        }
        n.bounds_work = effort.zones - before;
        n.bounds_known = true;
        return n.bounds;
    }

    // The points where automaton a is at the bound of its invariant.
    Federation<Z> at_bound(const Node<Z>& n, int a) const {
        Federation<Z> out;
        for (const auto& [automaton, b] : n.limits) {
            Z z = n.hull;
            if (automaton == a && (b.raw & 1) && constrain(z, b.j, b.i, static_cast<R>(2 - b.raw))) out.push_back(z);
        }
        return out;
    }

    // The points where automaton a can make an uncontrollable move of its own, followed or not. Of an automaton that
    // matters an unseen one is none; whatever one that cannot matter does is unseen, and its bounds oblige it alone.
    Federation<Z> own_moves(const Node<Z>& n, int a) const {
        Federation<Z> out;
        const bool matters = std::find(game_.unseen.begin(), game_.unseen.end(), a) == game_.unseen.end();
        for (const std::vector<Transition>* transitions : {&n.transitions, &n.unfollowed})
            for (const Transition& transition : *transitions) {
                const Joint& joint = joints_[transition.joint];
                if (joint.owner != a || joint.controllable || (matters && transition.unseen)) continue;
                Z anywhere = universe<Z>();
                if (invariant(nodes_[transition.target], anywhere)) before(n, joint, {anywhere}, out);
            }
        return out;
    }

    const Game& game_;
    const Restricted restricted_;
    bool all_ = false;  // new states get all their moves at once
    LimitMonitor& monitor_;
    Policy policy_;
    MaxConstants max_constants_;
    Joints joints_;
    States states_;
    std::deque<Node<Z>> nodes_;
    std::deque<int> queue_;  // hulls that grew, moves that came

  private:
    std::vector<int> enabled_;
    std::size_t symbolic_states_ = 0;
};

}  // namespace pursue
