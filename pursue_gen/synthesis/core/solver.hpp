// The game as a fixpoint on federations, one per discrete state.
//
// Rules and names (W, L, F, Stuck, Exp, ownU, cPre, uPre, Predt) are those of the design page on the game; a reaction
// delay keeps a command usable only where it stays right, and the environment harmless, for the whole delay.
#pragma once

#include "arena.hpp"

namespace pursue {

template <int N>
class Solver : public Arena<N> {
  public:
    using Arena<N>::Arena, Arena<N>::check;

    bool run() {
        initial_ = this->node(this->first());
        Node<N>& n = nodes_[initial_];
        n.reached = this->invariant(n.d, n.hull = origin<N>(game_.clocks));
        if (!n.reached) return false;
        this->elapse(n, n.hull);
        this->refresh(n);
        this->expand(initial_, game_.kind == Kind::safety);
        this->explore();
        if (game_.kind == Kind::safety) return !fixpoint();
        while (!fixpoint())
            if (!open_lost()) return false;
        return true;
    }

    // What to do in each state of the closed loop's universe, zones disjoint.
    std::vector<Action<N>> plan(const Node<N>& n) const { return game_.kind == Kind::safety ? safe_plan(n) : n.plan; }

    std::size_t evaluations() const { return evaluations_; }

  private:
    using Arena<N>::before, Arena<N>::at_bound, Arena<N>::own_moves, Arena<N>::won, Arena<N>::lost, Arena<N>::wake;
    using Arena<N>::open_lost, Arena<N>::game_, Arena<N>::limits_, Arena<N>::planner_, Arena<N>::nodes_;
    using Arena<N>::waiting_, Arena<N>::initial_;

    using Part = const Federation<N>& (*)(const Node<N>&);
    static constexpr std::size_t MANY = 4;

    // --- discrete predecessors --------------------------------------------------------------------------------------

    Federation<N> harm(const Node<N>& n, Part outside) const {
        Federation<N> out;
        for (std::size_t m = 0; m < n.moves.size(); ++m)
            if (!n.moves[m].controllable && n.targets[m] >= 0) {
                const Node<N>& target = nodes_[n.targets[m]];
                if (target.reached) append(out, before(n, n.moves[m], target, outside(target)));
            }
        return reduced(out);
    }

    // Per controllable move the points at which it may be commanded: right now and for the whole reaction delay.
    std::vector<std::pair<int, Federation<N>>> commands(const Node<N>& n, const Federation<N>& harmful, Part inside) const {
        std::vector<std::pair<int, Federation<N>>> out;
        for (std::size_t m = 0; m < n.moves.size(); ++m) {
            if (!n.moves[m].controllable || n.targets[m] < 0) continue;
            const Node<N>& target = nodes_[n.targets[m]];
            if (!target.reached) continue;
            Federation<N> good = before(n, n.moves[m], target, inside(target));
            if (game_.delta > 0 && !good.empty()) good = lasting(reduced(minus(good, harmful)), game_.delta);
            if (!good.empty()) out.emplace_back(static_cast<int>(m), reduced(good));
        }
        return out;
    }

    // --- fixpoints -------------------------------------------------------------------------------------------------

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

    static const Federation<N>& inside_of(const Node<N>& n) { return n.set; }
    static const Federation<N>& outside_of(const Node<N>& n) { return n.rest; }

    // Adds to a state's set. A set in many zones is often the complement of a complement in fewer.
    bool grow(Node<N>& n, const Federation<N>& fresh) {
        append(n.set, fresh);
        n.set = reduced(n.set);
        this->refresh(n);
        if (n.set.size() > MANY) {
            Federation<N> again = reduced(minus(Federation<N>{n.hull}, n.rest));
            if (again.size() < n.set.size()) n.set = std::move(again);
        }
        return true;
    }

    bool fill(Node<N>& n) {
        if (n.rest.empty()) return false;
        n.set = {n.hull};
        n.rest.clear();
        return true;
    }

    bool win_more(Node<N>& n) {
        if (lost(n.d)) return false;
        if (won(n.d)) return fill(n);
        if (n.rest.empty()) return false;
        const Federation<N> harmful = harm(n, outside_of);
        const auto usable = commands(n, harmful, inside_of);
        Federation<N> good = n.set;
        for (const auto& [move, zones] : usable) append(good, zones);
        for (int a = 0; a < static_cast<int>(game_.automata.size()); ++a) {
            const Federation<N> bound = at_bound(n, a);
            if (!bound.empty()) append(good, minus(intersection(own_moves(n, a), bound), harmful));
        }
        Federation<N> fresh = reduced(intersection(predt(good, harmful), n.rest));
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

    static Federation<N> past(const Node<N>& n, Federation<N> zones) {
        zones = reduced(zones);
        for (auto& z : zones) down(z);
        return reduced(intersection(reduced(zones), n.hull));
    }

    SafetyView look(const Node<N>& n, bool with_duty) const {
        SafetyView view;
        view.harmful = harm(n, inside_of);
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

    bool lose_more(Node<N>& n) {
        if (lost(n.d)) return fill(n);
        const Federation<N> fresh = reduced(minus(look(n, false).losing, n.set));
        return !fresh.empty() && grow(n, fresh);
    }

    // Safe points: where waiting for ever is safe, wait; else the command that a relaxed plan likes, else any safe one.
    std::vector<Action<N>> safe_plan(const Node<N>& n) const {
        std::vector<Action<N>> out;
        if (lost(n.d)) return out;
        Federation<N> safe = n.rest;
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

    int rank_ = 1;
    std::size_t evaluations_ = 0;
};

}  // namespace pursue
