// What both kinds of game share: a set of zones per discrete state that grows until nothing changes.
//
// Rules and names (W, L, F, Stuck, Exp, ownU, cPre, uPre, Predt) are those of the design page on the game; a reaction
// delay keeps a command usable only where it stays right, and uPre out of reach, for the whole delay.
#pragma once

#include <queue>
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

    void schedule(int k) {
        Node<Z>& n = nodes_[k];
        if (n.scheduled || !n.reached) return;
        n.scheduled = true;
        waiting_.emplace(n.deferred, order_++, k);
    }

    // Evaluates until the start is decided (true), nothing changes any more, or the budget is used up.
    bool iterate(double budget = std::numeric_limits<double>::infinity()) {
        const Z start = this->start_zone();
        for (work_ = 0; !waiting_.empty() && work_ < budget;) {
            const int k = std::get<2>(waiting_.top());
            waiting_.pop();
            nodes_[k].scheduled = false;
            monitor_.check(nodes_.size(), waiting_.size());
            ++evaluations_;
            ++work_;
            if (!evaluate(k)) continue;
            for (int p : nodes_[k].parents) schedule(p);
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
    // How many of its automata are deferred, order of arrival, state. An agent that is under way to an end which the
    // environment chooses stops time there, so sets grow slice by slice, an end at a time. Where no agent is under way
    // they are simple; known first, they spare the others most of their slices.
    using Waiting = std::tuple<int, std::size_t, int>;

    std::priority_queue<Waiting, std::vector<Waiting>, std::greater<Waiting>> waiting_;
    std::size_t order_ = 0;
    std::size_t evaluations_ = 0;
};

}  // namespace pursue
