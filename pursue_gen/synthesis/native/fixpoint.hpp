// What both kinds of game share: a set of zones per discrete state that grows until nothing changes.
//
// Rules and names (W, L, F, Stuck, Exp, ownU, cPre, uPre, Predt) are those of the design page on the game; a reaction
// delay keeps a command usable only where it stays right, and uPre out of reach, for the whole delay.
#pragma once

#include <map>
#include <memory>
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

    // What to do in the states that a play by the plans may come to: in a reach game at the clocks with which it does.
    // In a safety game whatever the clocks: such a strategy is its own certificate, which has to be closed.
    std::map<int, std::vector<Piece<Z>>> followed() {
        return game_.kind == Kind::safety ? followed_at_any_clocks() : followed_by_plays();
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

    // A discrete state on plays by the plans.
    struct Met {
        std::vector<Piece<Z>> pieces;       // what to do there
        std::vector<bool> used;             // which of it plays meet
        std::vector<Federation<Z>> strict;  // of each command's zone where a play does not go on without it
        std::vector<Z> entries;             // the zones at which plays enter it
    };

    // What plays by the plans meet; where a state is entered at more than `most` zones their hull takes their place, which
    // only adds plays.
    std::map<int, std::vector<Piece<Z>>> followed_by_plays() {
        constexpr std::size_t most = 8;
        std::vector<std::unique_ptr<Met>> met(nodes_.size());
        std::deque<std::pair<int, Z>> queue;
        const auto enter = [&](int k, Z z) {
            if (!met[k]) {
                met[k] = std::make_unique<Met>();
                meet(k, *met[k]);
            }
            Met& state = *met[k];
            if (state.pieces.empty()) return;
            for (const Z& entry : state.entries)
                if (includes(entry, z)) return;
            if (state.entries.size() >= most) {
                for (const Z& entry : state.entries) z = hull(z, entry);
                state.entries.clear();
            }
            insert(state.entries, z);
            queue.emplace_back(k, z);
        };
        for (enter(0, this->start_zone()); !queue.empty();) {
            const int k = queue.front().first;
            const Z entry = queue.front().second;
            queue.pop_front();
            this->check_limits();
            Met& here = *met[k];
            const auto same = [&](const Z& other) { return includes(entry, other) && includes(other, entry); };
            if (std::none_of(here.entries.begin(), here.entries.end(), same)) continue;  // a larger one took its place
            const Played play = played(nodes_[k], entry, here);
            for (const Transition& transition : nodes_[k].transitions) {
                const Joint& joint = joints_[transition.joint];
                const Node<Z>& target = nodes_[transition.target];
                const auto command = play.commanded.find(transition.joint);
                if (!target.reached || (joint.controllable && command == play.commanded.end())) continue;
                for (Z z : joint.controllable ? command->second : play.active)
                    if (this->step(joint, target, z)) enter(transition.target, z);
            }
        }
        std::map<int, std::vector<Piece<Z>>> plans;
        for (std::size_t k = 0; k < met.size(); ++k) {
            if (!met[k]) continue;
            std::vector<Piece<Z>> pieces;
            for (std::size_t p = 0; p < met[k]->pieces.size(); ++p)
                if (met[k]->used[p]) pieces.push_back(std::move(met[k]->pieces[p]));
            if (!pieces.empty()) plans.emplace(static_cast<int>(k), std::move(pieces));
        }
        return plans;
    }

    void meet(int k, Met& state) {
        state.pieces = plan(k);
        const Uncounted smaller;  // it makes a strategy smaller, once the game is decided
        state.used.resize(state.pieces.size(), false);
        state.strict.resize(state.pieces.size());
        for (std::size_t p = 0; p < state.pieces.size(); ++p) {
            const Piece<Z>& piece = state.pieces[p];
            if (piece.joint < 0) continue;
            state.strict[p] = {piece.zone};
            // Where another command may be on its way it may give way to that, and begin later (overtaking.py).
            for (const Piece<Z>& other : state.pieces) {
                if (game_.delta == 0 || other.joint < 0 || other.joint == piece.joint || other.rank >= piece.rank) continue;
                Z flight = other.zone;
                up_within(flight, game_.delta);
                if (touches(state.strict[p], flight)) state.strict[p] = minus(state.strict[p], flight);
            }
        }
    }

    // Where a play may be in a state until something happens, and where which command may take effect.
    struct Played {
        Federation<Z> active;
        std::map<int, Federation<Z>> commanded;
    };

    Played played(const Node<Z>& n, const Z& entry, Met& here) {
        const Uncounted smaller;
        const std::size_t count = here.pieces.size();
        std::vector<Federation<Z>> decided(count);
        Federation<Z> starts{entry}, waited;
        const auto decide = [&](std::size_t p, Z z) {  // anywhere on the way through its zone
            up(z);
            if (intersect(z, here.pieces[p].zone)) decided[p].push_back(z);
        };
        for (std::size_t p = 0; p < count; ++p) {
            if (here.pieces[p].joint < 0) continue;
            Z z = entry;
            if (!intersect(z, here.pieces[p].zone)) continue;
            decide(p, z);
            starts = minus(starts, here.strict[p]);
        }
        for (const Z& start : starts) {
            Z future = start;
            up(future);
            this->invariant(n, future);
            std::vector<std::pair<std::size_t, Z>> due;  // what ends the time that passes from here
            for (std::size_t p = 0; p < count; ++p)
                for (Z z : here.strict[p])
                    if (intersect(z, future)) due.emplace_back(p, z);
            Federation<Z> before{future};
            std::vector<Z> from;
            for (const auto& [p, z] : due) {
                from.push_back(z);
                up(from.back());
                before = minus(before, from.back());
            }
            for (std::size_t d = 0; d < due.size(); ++d) {
                Federation<Z> first{due[d].second};
                for (std::size_t other = 0; other < due.size() && !first.empty(); ++other) {
                    if (due[other].first == due[d].first) continue;
                    for (Z earlier : minus(Federation<Z>{due[other].second}, from[d])) {
                        up(earlier);
                        first = minus(first, earlier);
                    }
                }
                for (const Z& z : first) decide(due[d].first, z);
            }
            for (std::size_t p = 0; p < count; ++p)
                if (here.pieces[p].joint >= 0)
                    for (Z z : before)
                        if (intersect(z, here.pieces[p].zone)) decide(p, z);
            append(waited, before);
        }
        Played out;
        Federation<Z> flights;
        for (std::size_t p = 0; p < count; ++p)
            for (Z z : reduced(decided[p])) {
                here.used[p] = true;
                up_within(z, game_.delta);
                this->invariant(n, z);
                flights.push_back(z);
                out.commanded[here.pieces[p].joint].push_back(z);
            }
        if (game_.delta > 0)
            for (const Z& flight : flights)
                for (std::size_t p = 0; p < count; ++p) {
                    Z z = flight;
                    if (here.pieces[p].joint < 0 || !intersect(z, here.pieces[p].zone)) continue;
                    here.used[p] = true;
                    up_within(z, game_.delta);
                    if (intersect(z, flight)) out.commanded[here.pieces[p].joint].push_back(z);
                }
        append(waited, flights);
        out.active = reduced(waited);
        for (auto& [joint, zones] : out.commanded) zones = reduced(zones);
        for (std::size_t p = 0; p < count; ++p)
            here.used[p] = here.used[p] || (here.pieces[p].joint < 0 && touches(out.active, here.pieces[p].zone));
        return out;
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
        return reduced(std::move(out));
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
            if (!good.empty()) out.emplace_back(transition.joint, reduced(std::move(good)));
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
