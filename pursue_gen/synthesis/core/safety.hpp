// Safety: the least fixpoint of losing positions, L.
#pragma once

#include "fixpoint.hpp"

namespace pursue {

template <class Z>
class Safety : public Fixpoint<Z> {
  public:
    using Fixpoint<Z>::Fixpoint;

    bool run() override {
        if (!this->start()) return false;
        const std::vector<int> changed = this->explore();
        // What leads to a loss is looked at after what it leads to.
        for (auto k = changed.rbegin(); k != changed.rend(); ++k) this->wake(*k);
        return !this->settle();
    }

    // Safe points: where waiting for ever is safe, wait; else the command that a relaxed plan likes, else any safe one.
    std::vector<Action<Z>> plan(int k) override {
        Node<Z>& n = nodes_[k];
        std::vector<Action<Z>> out;
        if (n.lost || n.rest.empty()) return out;
        const Federation<Z> harmful = this->harm(n);
        auto usable = this->commands(n, harmful);
        const std::vector<int> liked = this->planner_.first_edges(this->state(k));
        const auto rank = [&](int joint) { return std::find(liked.begin(), liked.end(), this->joint(joint).edges[0]) - liked.begin(); };
        std::stable_sort(usable.begin(), usable.end(), [&](const auto& a, const auto& b) { return rank(a.first) < rank(b.first); });
        Federation<Z> evil = harmful;
        append(evil, obliged(n));
        const Federation<Z> duty = pasts(evil);  // from here the controller has to act some time
        Federation<Z> safe = n.rest, urgent = reduced(intersection(duty, safe));
        for (const auto& [joint, zones] : usable) {
            const Federation<Z> here = disjoint(intersection(urgent, minus(zones, harmful)));
            for (const Z& z : here) out.push_back({z, joint, 0});
            urgent = minus(urgent, here);
            safe = minus(safe, here);
        }
        for (const Z& z : disjoint(safe)) out.push_back({z, -1, 0});
        return out;
    }

  private:
    using Fixpoint<Z>::nodes_, Fixpoint<Z>::game_, Fixpoint<Z>::joints_;

    // Stuck before escapes are taken off: at the bound of an automaton that the environment cannot move.
    Federation<Z> obliged(const Node<Z>& n) const {
        Federation<Z> out;
        int last = -1;
        for (const auto& [a, bound] : n.limits) {
            if (a != last) append(out, minus(this->at_bound(n, a), this->own_moves(n, a)));
            last = a;
        }
        return out;
    }

    static Federation<Z> pasts(const Federation<Z>& zones) {
        Federation<Z> out;
        for (Z z : zones) {
            down(z);
            insert(out, z);
        }
        return out;
    }

    const Federation<Z>& winning(Node<Z>& n) const override { return n.rest; }
    const Federation<Z>& losing(Node<Z>& n) const override { return this->gathered(n); }

    // Of what is not lost yet: past(E) \ Predt(cPre(not L), E). L need not be in E: whoever comes to L by waiting
    // comes to what made it losing.
    bool evaluate(Node<Z>& n) override {
        if (n.rest.empty()) return false;
        if (n.lost) return this->decide_all(n);
        const Federation<Z> harmful = this->harm(n), bound = obliged(n);
        if (harmful.empty() && bound.empty()) return false;
        Federation<Z> escapes;
        for (const auto& [joint, zones] : this->commands(n, harmful)) append(escapes, zones);
        Federation<Z> evil = minus(bound, escapes);
        append(evil, harmful);
        const Federation<Z> danger = pasts(evil), ways = predt(minus(escapes, evil), evil);
        Federation<Z> lost, rest, cut;
        for (const Z& r : n.rest) {
            Federation<Z> gone;
            if (touches(danger, r))
                for (const Z& z : intersection(danger, minus(Federation<Z>{r}, ways))) absorb(gone, z);
            if (gone.empty()) {
                rest.push_back(r);
                continue;
            }
            append(cut, minus(Federation<Z>{r}, gone));
            append(lost, gone);
        }
        if (lost.empty()) return false;
        for (const Z& z : cut) absorb(rest, z);
        n.rest = std::move(rest);
        append(n.fresh, lost);
        return true;
    }
};

}  // namespace pursue
