// The Python face of the native engine: one function, plain lists in and out (see engine.py).
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <functional>
#include <unordered_map>

#include "guesses.hpp"
#include "reach.hpp"
#include "safety.hpp"
#include "zones/native/minimal.hpp"

namespace py = pybind11;
using namespace pursue;

namespace {

std::vector<Bound> bounds(const py::handle& list) {
    std::vector<Bound> out;
    for (const auto& item : list.cast<std::vector<std::tuple<int, int, wide_t>>>())
        out.push_back({std::get<0>(item), std::get<1>(item), std::get<2>(item)});
    return out;
}

std::vector<Test> tests(const py::handle& list) {
    std::vector<Test> out;
    for (const auto& item : list.cast<std::vector<std::pair<int, int>>>()) out.push_back({item.first, item.second});
    return out;
}

std::vector<Place> places(const py::handle& list) {
    std::vector<Place> out;
    for (const auto& item : list.cast<std::vector<std::pair<int, int>>>()) out.push_back({item.first, item.second});
    return out;
}

Game read_game(const py::dict& in) {
    Game game;
    const std::string kind = in["kind"].cast<std::string>();
    game.kind = kind == "reach" ? Kind::reach : kind == "safety" ? Kind::safety : Kind::reach_while_safe;
    game.clocks = in["clocks"].cast<int>();
    game.delta = in["delta"].cast<wide_t>();
    game.variables = in["variables"].cast<std::vector<int>>();
    game.start = bounds(in["start"]);
    game.unseen = in["unseen"].cast<std::vector<int>>();
    game.unseen_clocks = in["unseen_clocks"].cast<std::vector<int>>();
    game.goal = places(in["goal"]);
    game.bad = places(in["bad"]);
    for (const auto& a : in["automata"]) {
        Automaton automaton;
        for (const auto& location : a["invariants"]) automaton.invariants.push_back(bounds(location));
        automaton.initial = a["initial"].cast<int>();
        automaton.home = a["home"].cast<int>();
        for (const auto& e : a["edges"]) {
            Edge edge;
            edge.id = e["id"].cast<int>();
            edge.source = e["source"].cast<int>();
            edge.target = e["target"].cast<int>();
            edge.guard = bounds(e["guard"]);
            for (const auto& clause : e["clauses"]) edge.clauses.push_back(tests(clause));
            edge.channel = e["channel"].cast<int>();
            edge.sends = e["sends"].cast<bool>();
            edge.heard = e["heard"].cast<bool>();
            edge.assign = tests(e["assign"]);
            edge.resets = e["resets"].cast<std::vector<int>>();
            edge.controllable = e["controllable"].cast<bool>();
            automaton.edges.push_back(std::move(edge));
        }
        game.automata.push_back(std::move(automaton));
    }
    return game;
}

// The blocks of a strategy, as the Python side has them (RawBlock), and the ranks of their zones. A zone, or a command,
// that stands in many places is one value.
template <class Z>
class Blocks {
  public:
    using JointOf = std::function<const Joint&(int)>;

    Blocks(const Game& game, JointOf joint)
        : joint_(std::move(joint)), automata_(game.automata.size()), dim_(game.clocks + 1),
          no_bound_(py::module_::import("pursue_gen.zones.dbm").attr("INF")) {}

    void add(const Discrete& d, const std::vector<Piece<Z>>& pieces) {
        py::tuple zones(pieces.size()), numbers(pieces.size());
        for (std::size_t p = 0; p < pieces.size(); ++p) {
            put(zones, p, py::make_tuple(matrix(pieces[p].zone), action(pieces[p].joint)));
            put(numbers, p, py::int_(pieces[p].rank));
        }
        const auto values = d.begin() + static_cast<std::ptrdiff_t>(automata_);
        blocks.append(py::make_tuple(tuple_of(d.begin(), values), tuple_of(values, d.end()), zones));
        ranks.append(numbers);
    }

    py::list blocks, ranks;

  private:
    static void put(const py::tuple& to, std::size_t at, py::object item) {
        PyTuple_SET_ITEM(to.ptr(), static_cast<py::ssize_t>(at), item.release().ptr());
    }

    template <class It>
    static py::tuple tuple_of(It first, It last) {
        py::tuple out(last - first);
        for (std::size_t k = 0; first != last; ++first) put(out, k++, py::int_(*first));
        return out;
    }

    // The bounds, row by row.
    py::object matrix(const Z& z) {
        std::string bounds;
        for (int i = 0; i < dim_; ++i) bounds.append(reinterpret_cast<const char*>(z.row(i)), dim_ * sizeof(*z.m));
        py::object& found = matrices_[std::move(bounds)];
        if (found) return found;
        py::tuple out(dim_ * dim_);
        for (int i = 0; i < dim_; ++i)
            for (int j = 0; j < dim_; ++j)
                put(out, i * dim_ + j, z.at(i, j) >= INF<typename Z::raw_t> ? no_bound_ : py::int_(z.at(i, j)));
        return found = std::move(out);
    }

    // The edges of a command, None: wait.
    py::object action(int joint) {
        if (joint < 0) return py::none();
        py::object& found = actions_[joint];
        if (!found) found = tuple_of(joint_(joint).edges.begin(), joint_(joint).edges.end());
        return found;
    }

    const JointOf joint_;
    const std::size_t automata_;
    const int dim_;
    const py::object no_bound_;
    std::unordered_map<std::string, py::object> matrices_;
    std::unordered_map<int, py::object> actions_;
};

// What was found, without Python's objects.
template <class Z>
struct Found {
    std::unique_ptr<Fixpoint<Z>> solver;
    bool won;
    double seconds;
    std::map<int, std::vector<Piece<Z>>> plan;  // of the states that a play can come to
};

// Without the GIL: other threads go on.
template <class Z>
Found<Z> decide(const Game& game, LimitMonitor& monitor, double small_budget, bool soonest) {
    const py::gil_scoped_release released;
    Found<Z> found;
    if (game.kind == Kind::safety) std::tie(found.won, found.solver) = solve_safety<Z>(game, monitor, small_budget);
    else std::tie(found.won, found.solver) = solve_reach<Z>(game, monitor, small_budget, soonest);
    found.seconds = monitor.spent();
    if (found.won) found.plan = found.solver->followed();
    return found;
}

template <class Z>
py::dict outcome(bool won, double seconds, const Blocks<Z>& found, std::size_t reached, std::size_t zones,
                 std::size_t evaluations, std::size_t symbolic_states) {
    py::dict out;
    out["won"] = won;
    out["seconds"] = seconds;
    out["blocks"] = py::tuple(found.blocks);
    out["ranks"] = py::tuple(found.ranks);
    out["discrete_states"] = reached;
    out["symbolic_states"] = symbolic_states;
    out["zones"] = zones;
    out["evaluations"] = evaluations;
    out["work"] = effort.zones;
    return out;
}

template <class Z>
py::dict solve_with(const Game& game, const Limits& limits, double small_budget, bool soonest) {
    LimitMonitor monitor(limits);
    const Found<Z> found = decide<Z>(game, monitor, small_budget, soonest);
    const Fixpoint<Z>& solver = *found.solver;
    Blocks<Z> blocks(game, [&](int k) -> const Joint& { return solver.joint(k); });
    std::size_t reached = 0, zones = 0;
    for (const Node<Z>& node : solver.nodes()) {
        reached += node.reached;
        if (!found.won) zones += node.rest.size();
    }
    for (const auto& [k, pieces] : found.plan) {
        monitor.look();
        zones += pieces.size();
        blocks.add(solver.state(k), pieces);
    }
    return outcome(found.won, found.seconds, blocks, reached, zones, solver.evaluations(), solver.symbolic_states());
}

template <class Z>
py::dict guess_with(const Game& game, const Limits& limits, const std::vector<int>& late, bool turns) {
    LimitMonitor monitor(limits);
    Joints joints(game);
    Duties duties(game);
    std::map<Discrete, std::vector<Piece<Z>>> plan;
    std::unique_ptr<Forward<Z>> winning;
    double seconds = 0;
    {
        const py::gil_scoped_release released;
        winning = winning_guess<Z>(game, monitor, joints, duties, late, turns);
        seconds = monitor.spent();
        if (winning) plan = winning->plan();
    }
    Blocks<Z> blocks(game, [&](int k) -> const Joint& { return joints[k]; });
    std::size_t zones = 0;
    for (const auto& [d, pieces] : plan) {
        monitor.look();
        zones += pieces.size();
        blocks.add(d, pieces);
    }
    return outcome(winning != nullptr, seconds, blocks, plan.size(), zones, 0, winning ? winning->followed() : 0);
}

// Whether every finite bound that can come up fits: sums along a path through all clocks.
template <class R>
bool fits(const Game& game) {
    wide_t largest = game.delta;
    const auto note = [&](const std::vector<Bound>& bounds) {
        for (const Bound& b : bounds) largest = std::max(largest, std::abs(b.raw >> 1) + 1);
    };
    note(game.start);
    for (const Automaton& automaton : game.automata) {
        for (const auto& location : automaton.invariants) note(location);
        for (const Edge& edge : automaton.edges) note(edge.guard);
    }
    return (game.clocks + 2L) * (2L * largest + 2 * game.delta + 2) < INF<R>;
}

// Calls `run` with a zone of the size that the game needs.
template <class F>
py::dict sized(const Game& game, const F& run) {
    const int dim = game.clocks + 1;
#ifndef PURSUE_ONE_SIZE  // one size of matrices for all games: slower, and built in half the time
    if (fits<std::int16_t>(game)) {
        if (dim <= 4) return run(Dbm<4, std::int16_t>{});
        if (dim <= 5) return run(Dbm<5, std::int16_t>{});
        if (dim <= 6) return run(Dbm<6, std::int16_t>{});
        if (dim <= 8) return run(Dbm<8, std::int16_t>{});
        if (dim <= 12) return run(Dbm<12, std::int16_t>{});
        if (dim <= 16) return run(Dbm<16, std::int16_t>{});
    }
#endif
    if (!fits<wide_t>(game)) throw std::invalid_argument("constants too large");
#ifndef PURSUE_ONE_SIZE
    if (dim <= 8) return run(Dbm<8, wide_t>{});
    if (dim <= 12) return run(Dbm<12, wide_t>{});
    if (dim <= 16) return run(Dbm<16, wide_t>{});
    if (dim <= 24) return run(Dbm<24, wide_t>{});
    if (dim <= 40) return run(Dbm<40, wide_t>{});
#endif
    if (dim <= 128) return run(Dbm<128, wide_t>{});
    throw std::invalid_argument("more than 127 clocks");
}

Limits limits_of(double seconds, std::size_t states, std::size_t memory, std::uint64_t work, bool wall,
                 const py::object& progress) {
    Limits limits;
    limits.seconds = seconds;
    limits.wall = wall;
    limits.states = states;
    limits.memory = memory;
    limits.work = work;
    if (!progress.is_none())
        limits.progress = [&progress](std::size_t reached, std::size_t waiting, double spent, std::size_t mib) {
            const py::gil_scoped_acquire held;
            progress(reached, waiting, spent, mib);
        };
    limits.poll = [] {
        const py::gil_scoped_acquire held;
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    };
    return limits;
}

py::dict solve(const py::dict& in, double seconds, std::size_t states, std::size_t memory, std::uint64_t work, bool wall,
               const py::object& progress, double small_budget, bool soonest) {
    const GivesBack memory_of_game;
    const Game game = read_game(in);
    const Limits limits = limits_of(seconds, states, memory, work, wall, progress);
    return sized(game, [&](auto zone) { return solve_with<decltype(zone)>(game, limits, small_budget, soonest); });
}

py::dict guess(const py::dict& in, double seconds, std::size_t states, std::size_t memory, std::uint64_t work, bool wall,
               const py::object& progress, const std::vector<int>& late, bool turns) {
    const GivesBack memory_of_game;
    const Game game = read_game(in);
    const Limits limits = limits_of(seconds, states, memory, work, wall, progress);
    return sized(game, [&](auto zone) { return guess_with<decltype(zone)>(game, limits, late, turns); });
}

// A canonical matrix of Python's numbers, of any size; what 64 bits do not hold is no bound.
struct Matrix {
    using raw_t = std::int64_t;

    int dim;
    std::vector<raw_t> m;

    raw_t at(int i, int j) const { return m[i * dim + j]; }
};

std::vector<std::tuple<int, int, Matrix::raw_t>> minimal_bounds(int dim, const py::tuple& matrix) {
    Matrix z{dim, {}};
    if (dim < 1 || matrix.size() != static_cast<std::size_t>(dim) * dim) throw py::value_error("expected dim * dim bounds");
    z.m.reserve(matrix.size());
    for (const auto& bound : matrix) {
        int overflow = 0;
        const long long raw = PyLong_AsLongLongAndOverflow(bound.ptr(), &overflow);
        if (raw == -1 && PyErr_Occurred()) throw py::error_already_set();
        z.m.push_back(overflow ? INF<Matrix::raw_t> : raw);
    }
    return minimal(z, dim);
}

}  // namespace

PYBIND11_MODULE(_core, module) {
    keep_what_is_freed();
    module.doc() = "Native engine of the timed game solver.";
    py::register_exception<Limit>(module, "LimitReached");
    module.def("solve", &solve, py::arg("game"), py::arg("seconds") = 0.0, py::arg("states") = 0,
               py::arg("memory_mib") = 0, py::arg("work") = 0, py::arg("wall") = false, py::arg("progress") = py::none(),
               py::arg("small_budget") = 5e5, py::arg("soonest") = false,
               "Decides a compiled game. Raises LimitReached('seconds', 'states', 'memory' or 'work'). The seconds are of\n"
               "processor time, or (`wall`) of the clock. `small_budget` is the work, in zones, that the game gets as it\n"
               "is, before searches take turns. `soonest`: see Engine.solve.");
    module.def("guess", &guess, py::arg("game"), py::arg("seconds") = 0.0, py::arg("states") = 0,
               py::arg("memory_mib") = 0, py::arg("work") = 0, py::arg("wall") = false, py::arg("progress") = py::none(),
               py::arg("late") = std::vector<int>{}, py::arg("turns") = false,
               "Tries simple policies in a compiled safety game, see Engine.guess: where `late` names automata, those by which\n"
               "these duties wait until they are due. Limits as for `solve`.");
    module.def("minimal", &minimal_bounds, py::arg("dim"), py::arg("matrix"), "See strategy_from.minimal.");
}
