// Network and strategy put together: from the points at which a discrete state is entered, all that may follow (the twin
// of tests/oracle/closed_loop.py).
#pragma once

#include "proof/native/delays.hpp"

namespace pursue::proof {

// A location of an automaton.
struct Place {
    int automaton, location;
};

using Places = std::vector<Place>;

// A discrete state and the clocks' values just after the step into it.
template <class Z>
struct Entry {
    int state;
    Z zone;
};

template <class Z>
using Steps = std::vector<std::pair<const JointMove<Z>*, Entry<Z>>>;

// Numbers of zones and the ranks that they have.
using Ranks = std::vector<std::int64_t>;

template <class Z>
class ClosedLoop {
  public:
    using R = typename Z::raw_t;

    // `ranks` of all zones of the strategy; none: every play is followed. The tables and ranks must outlive the loop.
    ClosedLoop(const Tables& tables, std::int64_t factor, Rules rules, Places goal, Places bad, const Ranks* ranks,
               Watch& watch)
        : rules(rules), watch(watch), arena(tables.network, factor), strategy_(tables.strategy),
          goal_(std::move(goal)), bad_(std::move(bad)), ranks_(ranks) {}

    Rules rules;  // between two searches `prompt` may change: nothing that is kept depends on it
    Watch& watch;
    Arena<Z> arena;
    std::vector<bool> used;  // for each zone of the strategy whether plays reach it

    bool is_at(int state, const Place& place) const {
        return arena.state(state)[place.automaton] == place.location;
    }

    // All of the goal at once; any of what is bad.
    bool won(int state) const {
        return !goal_.empty() && std::all_of(goal_.begin(), goal_.end(), [&](const Place& p) { return is_at(state, p); });
    }
    bool lost(int state) const {
        return std::any_of(bad_.begin(), bad_.end(), [&](const Place& p) { return is_at(state, p); });
    }

    // All next entries. Throws Broken where the strategy fails on the way to them.
    Steps<Z> successors(const Entry<Z>& entry) {
        const int state = entry.state;
        if (won(state)) return {};
        if (lost(state)) throw Broken<Z>{Fault::bad, entry.zone};
        if (!blocks(state)) throw Broken<Z>{Fault::no_block, entry.zone};
        if (!ranks_) return steps(state, entry.zone);
        Steps<Z> out;
        Zones<Z> rest{entry.zone};
        for (const auto& [zone, key] : zones(state)) {
            Z common = entry.zone;
            if (!intersect(common, *zone)) continue;
            ranked(state, common, (*ranks_)[key], out);
            rest = without(rest, *zone, watch);
        }
        for (const Z& part : rest) ranked(state, part, 0, out);
        return out;
    }

    // The points of the discrete state for which there is advice; none where the game is lost.
    Zones<Z> covered(int state) {
        if (lost(state) || !blocks(state)) return {};
        if (!covered_.count(state)) covered_[state] = advice(state).covered(watch);
        return covered_[state];
    }

    // All that may follow if each of the covered points may be entered. Throws Broken where the strategy fails.
    Steps<Z> steps_from_all(int state) {
        const Zones<Z> all = covered(state);
        const Passage<Z> passage = pass(state, all, advice(state).waits);
        Zones<Z> active = all;
        // Nobody waits or decides elsewhere.
        for (const auto& [move, part] : passage.taken)
            if (!one_includes(all, part)) active.push_back(part);
        return entries(state, passage, active);
    }

    // Calls `moved` with each joint move that may happen in a state, and `compared` with each pair of a clock and a
    // constant that the strategy compares there.
    template <class M, class C>
    void describe(int state, M moved, C compared) {
        const std::vector<int>* here = blocks(state);
        if (won(state) || lost(state) || !here) return;
        const Situation<Z>& situation = arena.situation(state);
        for (const JointMove<Z>& move : situation.moves)
            if (!move.controllable && move.possible) moved(move);
        const auto note = [&](const std::vector<ZoneTable>& zones) {
            for (const ZoneTable& zone : zones)
                for (int c : zone) {
                    const Bound& bound = strategy_.constraints[c];
                    const std::int64_t size = std::abs(static_cast<std::int64_t>(arena.scaled(bound.raw)) >> 1);
                    for (int x : {bound.i, bound.j})
                        if (x) compared(x, size);
                }
        };
        for (int b : *here) {
            note(strategy_.blocks[b].wait);
            for (const CommandTable& command : strategy_.blocks[b].commands) {
                const JointMove<Z>* move = joint_move(command, situation).first;
                if (move && move->possible) moved(*move);
                note(command.zones);
            }
        }
    }

  private:
    const std::vector<int>* blocks(int state) {
        for (int known = static_cast<int>(blocks_.size()); known <= state; ++known) {
            const auto found = strategy_.of_state.find(arena.state(known));
            blocks_.push_back(found == strategy_.of_state.end() ? nullptr : &found->second);
        }
        return blocks_[state];
    }

    // All zones of the advice with their numbers.
    std::vector<std::pair<const Z*, int>> zones(int state) {
        const Advice<Z>& here = advice(state);
        std::vector<std::pair<const Z*, int>> out;
        for (const auto& [zone, key] : here.wait) out.emplace_back(&zone, key);
        for (const Act<Z>& act : here.acts) out.emplace_back(&act.zone, act.key);
        return out;
    }

    // Appends what follows from the points, which have this rank. Throws Broken where a step leads to no lower one.
    void ranked(int state, const Z& part, std::int64_t rank, Steps<Z>& out) {
        for (auto& step : steps(state, part)) {
            if (!won(step.second.state) && !is_lower(step.second, rank))
                throw Broken<Z>{Fault::no_progress, part, step.first};
            out.push_back(std::move(step));
        }
    }

    bool is_lower(const Entry<Z>& entry, std::int64_t rank) {
        if (!blocks(entry.state)) return false;
        std::vector<std::pair<const Z*, int>> lower = zones(entry.state);
        lower.erase(std::remove_if(lower.begin(), lower.end(), [&](const auto& one) { return (*ranks_)[one.second] >= rank; }),
                    lower.end());
        for (const auto& one : lower)
            if (includes(*one.first, entry.zone)) return true;
        Zones<Z> rest{entry.zone};
        for (const auto& one : lower) {
            rest = without(rest, *one.first, watch);
            if (rest.empty()) return true;
        }
        return false;
    }

    Steps<Z> steps(int state, const Z& zone) {
        const Passage<Z> passage = pass(state, {zone}, {zone});
        return entries(state, passage, passage.active(watch));
    }

    Passage<Z> pass(int state, const Zones<Z>& entries, const Zones<Z>& pieces) {
        Delay<Z> delay(arena.situation(state), advice(state), rules, arena.dim, watch);
        Passage<Z> passage = delay.pass(entries, pieces);
        for (int key : passage.used) {
            if (used.size() <= static_cast<std::size_t>(key)) used.resize(key + 1, false);
            used[key] = true;
        }
        return passage;
    }

    // Where commands lead that take effect, and what the environment may do at the active points.
    Steps<Z> entries(int state, const Passage<Z>& passage, const Zones<Z>& active) {
        Steps<Z> out;
        const auto step = [&](const JointMove<Z>& move, Z zone) {
            for (int x : move.resets) reset(zone, x);
            arena.check_width(zone);
            check_padding(zone, arena.dim);
            out.push_back({&move, {move.target, zone}});
        };
        for (const auto& [move, part] : passage.taken) step(*move, part);
        for (const JointMove<Z>& move : arena.situation(state).moves) {
            if (move.controllable || !move.possible) continue;
            for (const Z& part : active) {
                Z common = part;
                if (intersect(common, move.enabled)) step(move, common);
            }
        }
        return out;
    }

    const Advice<Z>& advice(int state) {
        std::unique_ptr<Advice<Z>>& found = advice_[state];
        if (found) return *found;
        auto made = std::make_unique<Advice<Z>>();
        const Situation<Z>& situation = arena.situation(state);
        // Within the invariant; those without a point are left out.
        const auto each = [&](const std::vector<ZoneTable>& tables, int& key, auto take) {
            for (const ZoneTable& table : tables) {
                Z zone = situation.invariant;
                if (within(zone, situation, table)) take(zone, key);
                ++key;
            }
        };
        for (int b : *blocks(state)) {
            const BlockTable& block = strategy_.blocks[b];
            int key = block.first;
            each(block.wait, key, [&](const Z& zone, int number) { made->wait.emplace_back(zone, number); });
            for (const CommandTable& command : block.commands) {
                const auto [move, fault] = joint_move(command, situation);
                const JointMove<Z>* named = move;
                const Fault why = fault;
                each(command.zones, key, [&](const Z& zone, int number) { made->acts.push_back({zone, number, named, why}); });
            }
        }
        made->complete(rules.reaction, arena.dim, watch);
        found = std::move(made);
        return *found;
    }

    bool within(Z& zone, const Situation<Z>& situation, const ZoneTable& table) const {
        if (!situation.possible) return false;
        for (int c : table) {
            const Bound& bound = strategy_.constraints[c];
            if (!constrain(zone, bound.i, bound.j, arena.scaled(bound.raw))) return false;
        }
        return true;
    }

    // The joint move that a command names, or none and why.
    std::pair<const JointMove<Z>*, Fault> joint_move(const CommandTable& command, const Situation<Z>& situation) const {
        const auto kind = [&](int edge) { return arena.network().edges[edge].kind; };
        for (const JointMove<Z>& move : situation.moves) {
            if (command.move.size() != move.edges.size() || command.move[0] != kind(move.edges[0])) continue;
            if (!std::all_of(move.edges.begin() + 1, move.edges.end(), [&](int edge) {
                    return std::find(command.move.begin() + 1, command.move.end(), kind(edge)) != command.move.end();
                }))
                continue;
            if (move.controllable) return {&move, Fault::no_joint_move};
            return {nullptr, Fault::not_controllable};
        }
        return {nullptr, Fault::no_joint_move};
    }

    const Strategy& strategy_;
    const Places goal_, bad_;
    const Ranks* ranks_;
    std::vector<const std::vector<int>*> blocks_;  // of each discrete state, none: it has no block
    std::unordered_map<int, std::unique_ptr<Advice<Z>>> advice_;
    std::unordered_map<int, Zones<Z>> covered_;
};

}  // namespace pursue::proof
