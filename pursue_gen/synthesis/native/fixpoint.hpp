// What both kinds of game share: a set of zones per discrete state that grows until nothing changes.
//
// Rules and names (W, L, F, Stuck, Exp, ownU, cPre, uPre, Predt) are those of the design page on the game; a reaction
// delay keeps a command usable only where it stays right, and uPre out of reach, for the whole delay.
#pragma once

#include <map>
#include <optional>
#include <queue>
#include <set>
#include <tuple>

#include "zone_graph.hpp"

namespace pursue {

template <class Z>
class Fixpoint : public ZoneGraph<Z> {
  public:
    using ZoneGraph<Z>::ZoneGraph;

    virtual ~Fixpoint() = default;

    // What to do in a state, zones disjoint.
    virtual std::vector<Piece<Z>> plan(int k) = 0;

    std::size_t evaluations() const { return evaluations_; }

    // What to do in the states that a play by the plans may come to: in a reach game by one hull of the clocks of each.
    // In a safety game whatever the clocks: such a strategy is its own certificate, which has to be closed.
    std::map<int, std::vector<Piece<Z>>> followed() {
        return game_.kind == Kind::safety ? followed_at_any_clocks() : followed_by_hulls();
    }

  private:
    std::map<int, std::vector<Piece<Z>>> followed_at_any_clocks() {
        std::map<int, std::vector<Piece<Z>>> plans;
        std::deque<int> queue{0};
        std::vector<bool> met(nodes_.size(), false);
        for (met[0] = true; !queue.empty();) {
            const int k = queue.front();
            queue.pop_front();
            this->check_limits();
            std::vector<Piece<Z>> pieces = plan(k);
            if (pieces.empty()) continue;
            std::set<int> commanded;
            for (const Piece<Z>& piece : pieces) commanded.insert(piece.joint);
            for (const Transition& transition : nodes_[k].transitions) {
                if (met[transition.target] || !nodes_[transition.target].reached) continue;
                if (joints_[transition.joint].controllable && !commanded.count(transition.joint)) continue;
                met[transition.target] = true;
                queue.push_back(transition.target);
            }
            plans.emplace(k, std::move(pieces));
        }
        return plans;
    }

    std::map<int, std::vector<Piece<Z>>> followed_by_hulls() {
        std::map<int, std::vector<Piece<Z>>> plans;
        std::map<int, Z> met;
        std::deque<int> queue{0};
        std::vector<bool> queued(nodes_.size(), false);
        const auto enter = [&](const Transition& transition, Z z) {
            const Node<Z>& target = nodes_[transition.target];
            if (!target.reached || !this->take(joints_[transition.joint], target, z)) return;
            const auto [known, fresh] = met.emplace(transition.target, z);
            if (!fresh) {
                if (includes(known->second, z)) return;
                known->second = hull(known->second, z);
                this->extrapolate_within(target, known->second);
            }
            if (queued[transition.target]) return;
            queued[transition.target] = true;
            queue.push_back(transition.target);
        };
        Z start = this->start_zone();
        this->elapse(nodes_[0], start);
        for (met.emplace(0, start); !queue.empty();) {
            const int k = queue.front();
            queue.pop_front();
            queued[k] = false;
            this->check_limits();
            const auto [known, fresh] = plans.try_emplace(k);
            if (fresh) known->second = plan(k);
            const Z here = met.at(k);
            std::map<int, Z> commanded;  // per joint move, where it may take effect
            std::optional<Z> anywhere;   // and where a play may be
            for (const Piece<Z>& piece : known->second) {
                Z z = piece.zone;
                if (!intersect(z, here)) continue;
                if (piece.joint >= 0) {
                    up_within(z, game_.delta);
                    if (!intersect(z, here)) continue;
                    const auto [other, first] = commanded.emplace(piece.joint, z);
                    if (!first) other->second = hull(other->second, z);
                }
                anywhere = anywhere ? hull(*anywhere, z) : z;
            }
            if (!anywhere) continue;
            for (const Transition& transition : nodes_[k].transitions) {
                const auto command = commanded.find(transition.joint);
                if (!joints_[transition.joint].controllable) enter(transition, *anywhere);
                else if (command != commanded.end()) enter(transition, command->second);
            }
        }
        for (auto k = plans.begin(); k != plans.end();) {
            const Z& here = met.at(k->first);
            std::vector<Piece<Z>>& pieces = k->second;  // without those that no play comes to
            const auto missed = [&](Piece<Z> piece) { return !intersect(piece.zone, here); };
            pieces.erase(std::remove_if(pieces.begin(), pieces.end(), missed), pieces.end());
            k = pieces.empty() ? plans.erase(k) : std::next(k);
        }
        return plans;
    }

  protected:
    using ZoneGraph<Z>::game_, ZoneGraph<Z>::nodes_, ZoneGraph<Z>::joints_, ZoneGraph<Z>::monitor_;
    using ZoneGraph<Z>::before;

    using Usable = std::vector<std::pair<int, Federation<Z>>>;  // per joint move, where it may be commanded

    // Evaluates a state (again); true: more of it is decided.
    virtual bool evaluate(int k) = 0;

    // Whether the start is decided, with this zone of clocks and what is not decided of its state.
    virtual bool decided(const Federation<Z>& rest, const Z& start) const = 0;

    virtual const Federation<Z>& winning(Node<Z>& n) const = 0;
    virtual const Federation<Z>& losing(Node<Z>& n) const = 0;

    // How soon a state is evaluated again, the smallest first.
    virtual std::int64_t due(int k) const { return nodes_[k].deferred; }

    // The same for a state before one that was evaluated when `when` was due.
    virtual std::int64_t due_before(int k, [[maybe_unused]] int target, [[maybe_unused]] std::int64_t when) {
        return due(k);
    }

    void schedule(int k) { schedule(k, due(k)); }

    void schedule(int k, std::int64_t when) {
        Node<Z>& n = nodes_[k];
        if (!n.reached || (n.scheduled && n.when <= when)) return;
        n.scheduled = true;
        n.when = when;
        waiting_.emplace(when, order_++, k);
    }

    // Evaluates until the start is decided (true), nothing changes any more, or the budget is used up.
    bool iterate(double budget = std::numeric_limits<double>::infinity()) {
        const Z start = this->start_zone();
        for (work_ = 0; !waiting_.empty() && work_ < budget;) {
            const std::int64_t when = std::get<0>(waiting_.top());
            const int k = std::get<2>(waiting_.top());
            waiting_.pop();
            if (!nodes_[k].scheduled || nodes_[k].when != when) continue;  // it was, sooner
            nodes_[k].scheduled = false;
            monitor_.check(nodes_.size(), waiting_.size());
            ++evaluations_;
            ++work_;
            if (!evaluate(k)) continue;
            for (int p : nodes_[k].parents) schedule(p, due_before(p, k, when));
            if (k == 0 && decided(nodes_[0].rest, start)) return true;
        }
        return decided(nodes_[0].rest, start);
    }

    bool converged() const { return waiting_.empty(); }

    // --- discrete predecessors --------------------------------------------------------------------------------------

    // uPre of what is losing: where an uncontrollable move leads there.
    Federation<Z> upre(const Node<Z>& n) {
        Federation<Z> out;
        for (const Transition& transition : n.transitions) {
            const Joint& joint = joints_[transition.joint];
            Node<Z>& target = nodes_[transition.target];
            if (!joint.controllable && target.reached) before(n, joint, losing(target), out);
        }
        return out.size() > 1 ? reduced(out) : out;
    }

    // cPre of what is winning, per move: the points at which it may be commanded, right now and for the whole reaction
    // delay, without an uncontrollable move into what is losing meanwhile (`unsafe`).
    Usable cpre(const Node<Z>& n, const Federation<Z>& unsafe) {
        Usable out;
        for (const Transition& transition : n.transitions) {
            const Joint& joint = joints_[transition.joint];
            Node<Z>& target = nodes_[transition.target];
            if (!joint.controllable || !target.reached) continue;
            Federation<Z> good;
            before(n, joint, winning(target), good);
            if (game_.delta > 0 && !good.empty()) good = lasting(reduced(minus(good, unsafe)), game_.delta);
            if (!good.empty()) out.emplace_back(transition.joint, reduced(good));
        }
        return out;
    }

    static bool decide_all(Node<Z>& n) {
        if (n.rest.empty()) return false;
        n.done = {n.hull};
        n.fresh.clear();
        n.rest.clear();
        return true;
    }

    double work_ = 0;  // of the budget, in zones or pairs of zones: the same on every machine

  private:
    // When it is due, order of arrival, state. As a rule it is due by how many of its automata are deferred. An agent
    // that is under way to an end which the environment chooses stops time there, so sets grow slice by slice, an end at
    // a time. Where no agent is under way they are simple; known first, they spare the others most of their slices.
    using Waiting = std::tuple<std::int64_t, std::size_t, int>;

    std::priority_queue<Waiting, std::vector<Waiting>, std::greater<Waiting>> waiting_;
    std::size_t order_ = 0;
    std::size_t evaluations_ = 0;
};

}  // namespace pursue
