// Discrete states, each stored once, and the joint moves that lead from one to another.
#pragma once

#include <deque>

#include "game.hpp"

namespace pursue {

// Numbers discrete states in the order in which they come; open addressing on one pool, no allocation per state.
class States {
  public:
    explicit States(std::size_t width) : width_(width), slots_(1024, -1) {}

    std::size_t size() const { return pool_.size() / width_; }
    std::size_t width() const { return width_; }

    Discrete operator[](int k) const {
        const auto first = pool_.begin() + static_cast<std::ptrdiff_t>(k * width_);
        return Discrete(first, first + static_cast<std::ptrdiff_t>(width_));
    }

    // The number of a state; size() - 1 afterwards if it is new.
    int number(const Discrete& d) {
        assert(d.size() == width_);
        if (2 * size() >= slots_.size()) grow();
        std::size_t slot = place(d.data());
        if (slots_[slot] < 0) {
            slots_[slot] = static_cast<int>(size());
            pool_.insert(pool_.end(), d.begin(), d.end());
        }
        return slots_[slot];
    }

  private:
    std::size_t place(const std::int32_t* d) const {
        std::uint64_t hash = 0x9e3779b97f4a7c15;
        for (std::size_t k = 0; k < width_; ++k) {
            hash = (hash ^ static_cast<std::uint32_t>(d[k])) * 0xff51afd7ed558ccd;
            hash ^= hash >> 32;
        }
        std::size_t slot = hash % slots_.size();
        while (slots_[slot] >= 0 && !std::equal(d, d + width_, pool_.data() + slots_[slot] * width_))
            slot = (slot + 1) % slots_.size();
        return slot;
    }

    void grow() {
        slots_.assign(2 * slots_.size(), -1);
        for (std::size_t k = 0; k < size(); ++k) slots_[place(pool_.data() + k * width_)] = static_cast<int>(k);
    }

    std::size_t width_;
    std::vector<std::int32_t> pool_;
    std::vector<int> slots_;
};

// Answers to a question about discrete states, each found out once as long as they are not too many.
class Answers {
  public:
    explicit Answers(std::size_t width) : states_(width) {}

    // The answer for a state; `found()` where it is not known.
    template <class Found>
    bool of(const Discrete& d, Found found) {
        if (answers_.size() >= MOST_KEPT) {
            answers_.clear();
            states_ = States(states_.width());
        }
        const auto number = static_cast<std::size_t>(states_.number(d));
        if (number == answers_.size()) {
            answers_.push_back(false);
            answers_[number] = found();
        }
        return answers_[number];
    }

  private:
    static constexpr std::size_t MOST_KEPT = 1 << 17;  // states, some hundred bytes each

    States states_;
    std::vector<bool> answers_;
};

// What a joint move does wherever it is enabled: a sender (or an own step), and of every other automaton with enabled
// receiving edges one of them. Guards read the state before; assignments run sender first, then receivers in system order.
struct Joint {
    std::vector<int> edges;  // ids, sender first
    int owner;               // automaton of the sender
    bool controllable;
    std::vector<Bound> guard;
    std::vector<int> resets;
    std::vector<std::pair<int, int>> writes;  // index in the discrete state, value
    std::vector<std::pair<int, int>> extensions;  // edge id, number of the joint move that has this edge as well

    // True for a move that is none: it leads back to d, and no clock notices; a command also if it is unseen.
    bool changes_nothing(const Discrete& d, const Game& game) const {
        return controllable ? is_unseen(d, game) : resets.empty() && leads_back(d, {});
    }

    // True for a move from d that changes at most what cannot matter.
    bool is_unseen(const Discrete& d, const Game& game) const {
        return leads_back(d, game.unseen) && std::all_of(resets.begin(), resets.end(), [&](int x) {
                   return std::find(game.unseen_clocks.begin(), game.unseen_clocks.end(), x) != game.unseen_clocks.end();
               });
    }

    Discrete target(Discrete d) const {
        for (const auto& [index, value] : writes) d[index] = value;
        return d;
    }

  private:
    // Whether it leads from d to d but for these parts of it. Of several writes to one part the last one counts.
    bool leads_back(const Discrete& d, const std::vector<int>& but) const {
        for (auto write = writes.rbegin(); write != writes.rend(); ++write) {
            const auto& [index, value] = *write;
            if (d[index] == value || std::find(but.begin(), but.end(), index) != but.end()) continue;
            if (std::none_of(writes.rbegin(), write, [i = index](const auto& later) { return later.first == i; })) return false;
        }
        return true;
    }
};

// All joint moves of a game, made when they are met first.
class Joints {
  public:
    explicit Joints(const Game& game) : game_(game), count_(static_cast<int>(game.automata.size())) {
        for (int a = 0; a < count_; ++a) {
            auto& own = senders_.emplace_back(game.automata[a].invariants.size());
            auto& receiving = receivers_.emplace_back(game.automata[a].invariants.size());
            for (const Edge& edge : game.automata[a].edges) {
                if (edge.channel >= 0 && !edge.sends) receiving[edge.source].push_back(&edge);
                else own[edge.source].emplace_back(&edge, add(edge, a));
            }
        }
    }

    const Joint& operator[](int k) const { return joints_[k]; }

    // The numbers of the joint moves whose discrete guards hold in d.
    void enabled(const Discrete& d, std::vector<int>& out) {
        out.clear();
        for (int a = 0; a < count_; ++a)
            for (const auto& [sender, joint] : senders_[a][d[a]]) {
                if (!holds(game_, d, sender->clauses)) continue;
                const std::size_t first = out.size();
                out.push_back(joint);
                for (int b = 0; sender->channel >= 0 && b < count_; ++b)
                    if (b != a) add_receivers(d, b, sender->channel, first, out);
                if (sender->heard)
                    out.erase(std::remove_if(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(),
                                             [&](int k) { return !is_heard(joints_[k], *sender, d); }),
                              out.end());
            }
    }

  private:
    // Whether the move from d changes more than where its sender is, and its clocks.
    bool is_heard(const Joint& joint, const Edge& sender, const Discrete& d) const {
        Discrete after = joint.target(d);
        after[joint.owner] = d[joint.owner];
        return after != d || std::any_of(joint.resets.begin(), joint.resets.end(), [&](int x) {
                   return std::find(sender.resets.begin(), sender.resets.end(), x) == sender.resets.end();
               });
    }

    int add(const Edge& edge, int automaton) {
        Joint joint{{}, automaton, true, edge.guard, {}, {}, {}};
        extend(joint, edge, automaton);
        joints_.push_back(std::move(joint));
        return static_cast<int>(joints_.size()) - 1;
    }

    void extend(Joint& joint, const Edge& edge, int automaton) const {
        joint.edges.push_back(edge.id);
        joint.controllable = joint.controllable && edge.controllable;
        joint.resets.insert(joint.resets.end(), edge.resets.begin(), edge.resets.end());
        joint.writes.emplace_back(automaton, edge.target);
        for (const auto& set : edge.assign) joint.writes.emplace_back(count_ + set.variable, set.value);
    }

    // Every move from `first` on goes on with each enabled receiving edge of automaton b, if there is one.
    void add_receivers(const Discrete& d, int b, int channel, std::size_t first, std::vector<int>& out) {
        const std::size_t last = out.size();
        for (std::size_t k = first; k < last; ++k)
            for (const Edge* edge : receivers_[b][d[b]])
                if (edge->channel == channel && holds(game_, d, edge->clauses)) out.push_back(extended(out[k], *edge, b));
        const auto begin = out.begin() + static_cast<std::ptrdiff_t>(first);
        if (out.size() > last) out.erase(begin, begin + static_cast<std::ptrdiff_t>(last - first));
    }

    int extended(int k, const Edge& edge, int automaton) {
        for (const auto& [id, number] : joints_[k].extensions)
            if (id == edge.id) return number;
        Joint joint = joints_[k];
        joint.extensions.clear();
        extend(joint, edge, automaton);
        joints_.push_back(std::move(joint));
        joints_[k].extensions.emplace_back(edge.id, static_cast<int>(joints_.size()) - 1);
        return static_cast<int>(joints_.size()) - 1;
    }

    const Game& game_;
    int count_;
    std::deque<Joint> joints_;
    std::vector<std::vector<std::vector<std::pair<const Edge*, int>>>> senders_;  // per automaton and location
    std::vector<std::vector<std::vector<const Edge*>>> receivers_;
};

}  // namespace pursue
