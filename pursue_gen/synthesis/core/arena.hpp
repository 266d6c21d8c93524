// The arena of a game: discrete states with one hull of zones each, the moves that are followed, symbolic steps.
#pragma once

#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
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
    std::size_t memory = 0;                 // MiB of the whole process, 0: none
    std::function<void()> poll = [] {};     // called now and then; may throw (Ctrl-C)
    // Called a few times a second, and before a limit is thrown: states, waiting, seconds, MiB. May throw.
    std::function<void(std::size_t, std::size_t, double, std::size_t)> progress;
};

// MiB of this process in memory; where the system does not tell, the most that it was so far.
inline std::size_t memory_in_use() {
    if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
        unsigned long pages = 0;
        const int read = std::fscanf(file, "%*u %lu", &pages);
        std::fclose(file);
        if (read == 1) return static_cast<std::size_t>(pages) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) >> 20;
    }
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
#ifdef __APPLE__
    return static_cast<std::size_t>(usage.ru_maxrss) >> 20;
#else
    return static_cast<std::size_t>(usage.ru_maxrss) >> 10;
#endif
}

template <int N>
struct Action {
    Dbm<N> zone;
    int move;  // index into Node::moves, -1: wait
    int rank;  // reach: every step from here leads to lower ranks
};

template <int N>
struct Node {
    Discrete d;
    Dbm<N> hull{};
    std::vector<raw_t> max;        // the largest constants that matter here
    bool reached = false, full = false, queued = false;
    std::vector<Move> moves;
    std::vector<int> targets;      // node per move, -1: not followed
    std::vector<int> parents;
    Federation<N> set;             // reach: winning; safety: losing
    Federation<N> rest;            // of the hull, what is not (yet) in the set
    std::vector<Action<N>> plan;   // reach: in the order in which the points were won
};

template <int N>
class Arena {
  public:
    Arena(const Game& game, const Limits& limits)
        : game_(game), limits_(limits), start_(std::chrono::steady_clock::now()), planner_(game, wish(game)), horizon_(game) {}

    const std::deque<Node<N>>& nodes() const { return nodes_; }

  protected:
    // --- discrete states -------------------------------------------------------------------------------------------

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
            if (limits_.states && nodes_.size() >= limits_.states) stop("states");
            check();
            nodes_.emplace_back();
            nodes_.back().d = d;
            nodes_.back().max = horizon_.at(d, N);
        }
        return it->second;
    }

    double spent() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

    void check() {
        const double now = spent();
        if (limits_.seconds > 0 && now > limits_.seconds) stop("seconds");
        if (now < look_) return;
        look_ = now + 0.02;  // looking at memory costs a system call or three
        limits_.poll();
        const std::size_t memory = memory_in_use();
        if (limits_.memory && memory > limits_.memory) stop("memory");
        if (now < tell_) return;
        tell_ = now + 0.2;
        if (limits_.progress) limits_.progress(nodes_.size(), waiting_.size() + touched_.size(), now, memory);
    }

    [[noreturn]] void stop(const char* which) const {
        if (limits_.progress) limits_.progress(nodes_.size(), waiting_.size() + touched_.size(), spent(), memory_in_use());
        throw Limit(which);
    }

    bool invariant(const Discrete& d, Dbm<N>& z) const {
        for (std::size_t a = 0; a < game_.automata.size(); ++a)
            for (const Bound& b : game_.automata[a].invariants[d[a]])
                if (!constrain(z, b.i, b.j, b.raw)) return false;
        return true;
    }

    void elapse(const Node<N>& n, Dbm<N>& z) const {
        up(z);
        invariant(n.d, z);
        forget(n, z);
    }

    void forget(const Node<N>& n, Dbm<N>& z) const {
        extrapolate(z, n.max);
        invariant(n.d, z);
    }

    // Decides which moves of a state are followed: all, or every uncontrollable one and one controllable one.
    void expand(int k, bool full) {
        Node<N>& n = nodes_[k];
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
                Node<N>& target = nodes_[t];
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
                refresh(target);
                if (fresh) expand(t, game_.kind == Kind::safety);
                else touched_.push_back(t);
                if (fresh && nodes_[t].moves.empty()) wake(t);
                for (int p : nodes_[t].parents) wake(p);
            }
        }
    }

    static void refresh(Node<N>& n) { n.rest = reduced(minus(Federation<N>{n.hull}, n.set)); }

    // After a loss with few moves: states that are not won get all of theirs. False when all of them had them.
    bool open_lost() {
        const std::size_t count = nodes_.size();
        for (std::size_t k = 0; k < count; ++k)
            if (nodes_[k].reached && !nodes_[k].full && !nodes_[k].rest.empty())
                expand(static_cast<int>(k), true);
        const bool more = !touched_.empty();
        explore();
        return more;
    }

    void wake(int k) {
        if (nodes_[k].queued) return;
        nodes_[k].queued = true;
        waiting_.push_back(k);
    }

    // --- symbolic steps --------------------------------------------------------------------------------------------

    static bool guard(const Move& move, Dbm<N>& z) {
        for (const Bound& b : move.guard)
            if (!constrain(z, b.i, b.j, b.raw)) return false;
        return true;
    }

    // The points of n from which the move leads into `zones` of its target.
    Federation<N> before(const Node<N>& n, const Move& move, const Node<N>& target, const Federation<N>& zones) const {
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

    // The points where automaton a is at the bound of its invariant.
    Federation<N> at_bound(const Node<N>& n, int a) const {
        Federation<N> out;
        for (const Bound& b : game_.automata[a].invariants[n.d[a]]) {
            Dbm<N> z = n.hull;
            if ((b.raw & 1) && constrain(z, b.j, b.i, 1 - b.raw + 1)) out.push_back(z);
        }
        return out;
    }

    // The points where automaton a can make an uncontrollable move of its own.
    Federation<N> own_moves(const Node<N>& n, int a) const {
        Federation<N> out;
        for (std::size_t m = 0; m < n.moves.size(); ++m)
            if (n.moves[m].owner == a && !n.moves[m].controllable && n.targets[m] >= 0) {
                const Node<N>& target = nodes_[n.targets[m]];
                if (target.reached) append(out, before(n, n.moves[m], target, {target.hull}));
            }
        return out;
    }

    const Game& game_;
    const Limits& limits_;
    std::chrono::steady_clock::time_point start_;
    RelaxedPlanner planner_;
    Horizon horizon_;
    std::deque<Node<N>> nodes_;
    std::map<Discrete, int> index_;
    std::deque<int> touched_, waiting_;  // hulls that grew; states whose surroundings changed
    int initial_ = 0;
    double look_ = 0, tell_ = 0;  // when to look at memory, and to tell the progress, again

  private:
    // What the controller wishes for when it may choose: the goal, or to have the duty of the safety objective behind it.
    static Place wish(const Game& game) {
        if (game.kind != Kind::safety) return game.goal;
        return {game.bad.automaton, game.automata[game.bad.automaton].initial};
    }

};

}  // namespace pursue
