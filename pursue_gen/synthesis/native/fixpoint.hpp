// What both kinds of game share: a set of zones per discrete state that grows until nothing changes.
//
// Rules and names (W, L, F, Stuck, Exp, ownU, cPre, uPre, Predt) are those of the design page on the game; a reaction
// delay keeps a command usable only where it stays right, and the environment harmless, for the whole delay.
#pragma once

#include <queue>
#include <tuple>

#include "arena.hpp"

namespace pursue {

template <class Z>
class Fixpoint : public Arena<Z> {
  public:
    using Arena<Z>::Arena;

    virtual ~Fixpoint() = default;

    // What to do in a state, zones disjoint.
    virtual std::vector<Action<Z>> plan(int k) = 0;

    std::size_t evaluations() const { return evaluations_; }

  protected:
    using Arena<Z>::game_, Arena<Z>::nodes_, Arena<Z>::joints_, Arena<Z>::watch_, Arena<Z>::before;

    using Usable = std::vector<std::pair<int, Federation<Z>>>;  // per joint move, where it may be commanded

    // Looks at a state again; true: more of it is decided.
    virtual bool evaluate(Node<Z>& n) = 0;

    // Whether the start is decided, with this zone of clocks and what is not decided of its state.
    virtual bool decided(const Federation<Z>& rest, const Z& start) const = 0;

    virtual const Federation<Z>& winning(Node<Z>& n) const = 0;
    virtual const Federation<Z>& losing(Node<Z>& n) const = 0;

    void wake(int k) {
        Node<Z>& n = nodes_[k];
        if (n.waiting || !n.reached) return;
        n.waiting = true;
        waiting_.emplace(n.travellers, order_++, k);
    }

    // Until the start is decided (true), nothing changes any more, or the work is done.
    bool settle(double work = std::numeric_limits<double>::infinity()) {
        const Z start = this->beginning();
        for (work_ = 0; !waiting_.empty() && work_ < work;) {
            const int k = std::get<2>(waiting_.top());
            waiting_.pop();
            nodes_[k].waiting = false;
            watch_.look(nodes_.size(), waiting_.size());
            ++evaluations_;
            ++work_;
            if (!evaluate(nodes_[k])) continue;
            for (int p : nodes_[k].parents) wake(p);
            if (k == 0 && decided(nodes_[0].rest, start)) return true;
        }
        return decided(nodes_[0].rest, start);
    }

    bool settled() const { return waiting_.empty(); }

    // --- discrete predecessors --------------------------------------------------------------------------------------

    Federation<Z> harm(const Node<Z>& n) {
        Federation<Z> out;
        for (const Step& step : n.steps) {
            const Joint& joint = joints_[step.joint];
            Node<Z>& target = nodes_[step.target];
            if (!joint.controllable && target.reached) before(n, joint, losing(target), out);
        }
        return out.size() > 1 ? reduced(out) : out;
    }

    // Per controllable move the points at which it may be commanded: right now and for the whole reaction delay.
    Usable commands(const Node<Z>& n, const Federation<Z>& harmful) {
        Usable out;
        for (const Step& step : n.steps) {
            const Joint& joint = joints_[step.joint];
            Node<Z>& target = nodes_[step.target];
            if (!joint.controllable || !target.reached) continue;
            Federation<Z> good;
            before(n, joint, winning(target), good);
            if (game_.delta > 0 && !good.empty()) good = lasting(reduced(minus(good, harmful)), game_.delta);
            if (!good.empty()) out.emplace_back(step.joint, reduced(good));
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

    double work_ = 0;  // pairs of zones that were looked at, roughly: the same on every machine

  private:
    // How many are under way, order of arrival, state. An agent that is under way to an end which the environment
    // chooses stops time there, so sets grow slice by slice, an end at a time. Where nobody is under way they are simple;
    // known first, they spare the others most of their slices.
    using Waiting = std::tuple<int, std::size_t, int>;

    std::priority_queue<Waiting, std::vector<Waiting>, std::greater<Waiting>> waiting_;
    std::size_t order_ = 0;
    std::size_t evaluations_ = 0;
};

}  // namespace pursue
