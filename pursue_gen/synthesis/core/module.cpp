// The Python face of the native engine: one function, plain lists in and out (see synthesis/native.py).
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "solver.hpp"

namespace py = pybind11;
using namespace pursue;

namespace {

std::vector<Bound> bounds(const py::handle& list) {
    std::vector<Bound> out;
    for (const auto& item : list.cast<std::vector<std::tuple<int, int, raw_t>>>())
        out.push_back({std::get<0>(item), std::get<1>(item), std::get<2>(item)});
    return out;
}

std::vector<Test> tests(const py::handle& list) {
    std::vector<Test> out;
    for (const auto& item : list.cast<std::vector<std::pair<int, int>>>()) out.push_back({item.first, item.second});
    return out;
}

Place place(const py::handle& pair) {
    if (pair.is_none()) return {};
    const auto p = pair.cast<std::pair<int, int>>();
    return {p.first, p.second};
}

Game read_game(const py::dict& in) {
    Game game;
    const std::string kind = in["kind"].cast<std::string>();
    game.kind = kind == "reach" ? Kind::reach : kind == "safety" ? Kind::safety : Kind::reach_while_safe;
    game.clocks = in["clocks"].cast<int>();
    game.delta = in["delta"].cast<raw_t>();
    game.variables = in["variables"].cast<std::vector<int>>();
    game.goal = place(in["goal"]);
    game.bad = place(in["bad"]);
    for (const auto& a : in["automata"]) {
        Automaton automaton;
        for (const auto& location : a["invariants"]) automaton.invariants.push_back(bounds(location));
        automaton.initial = a["initial"].cast<int>();
        for (const auto& e : a["edges"]) {
            Edge edge;
            edge.id = e["id"].cast<int>();
            edge.source = e["source"].cast<int>();
            edge.target = e["target"].cast<int>();
            edge.guard = bounds(e["guard"]);
            for (const auto& clause : e["clauses"]) edge.clauses.push_back(tests(clause));
            edge.channel = e["channel"].cast<int>();
            edge.sends = e["sends"].cast<bool>();
            edge.assign = tests(e["assign"]);
            edge.resets = e["resets"].cast<std::vector<int>>();
            edge.controllable = e["controllable"].cast<bool>();
            automaton.edges.push_back(std::move(edge));
        }
        game.automata.push_back(std::move(automaton));
    }
    return game;
}

template <int N>
py::dict solve_with(const Game& game, const Limits& limits) {
    Solver<N> solver(game, limits);
    const bool won = solver.run();
    py::dict out;
    py::list states;
    std::size_t reached = 0, zones = 0;
    const int dim = game.clocks + 1;
    for (const auto& node : solver.nodes()) {
        if (!node.reached) continue;
        ++reached;
        zones += node.set.size();
        if (!won) continue;
        solver.check();
        py::list actions;
        for (const auto& action : solver.plan(node)) {
            std::vector<raw_t> matrix;
            for (int i = 0; i < dim; ++i)
                for (int j = 0; j < dim; ++j) matrix.push_back(action.zone.at(i, j));
            actions.append(py::make_tuple(matrix, action.move < 0 ? py::object(py::none())
                                                                   : py::cast(node.moves[action.move].edges),
                                           action.rank));
        }
        if (!actions.empty()) states.append(py::make_tuple(node.d, actions));
    }
    out["won"] = won;
    out["states"] = states;
    out["discrete_states"] = reached;
    out["zones"] = zones;
    out["evaluations"] = solver.evaluations();
    return out;
}

py::dict solve(const py::dict& in, double seconds, std::size_t states, std::size_t memory, const py::object& progress) {
    const Game game = read_game(in);
    Limits limits;
    limits.seconds = seconds;
    limits.states = states;
    limits.memory = memory;
    if (!progress.is_none())
        limits.progress = [&progress](std::size_t reached, std::size_t waiting, double spent, std::size_t mib) {
            progress(reached, waiting, spent, mib);
        };
    limits.poll = [] {
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    };
    const int dim = game.clocks + 1;
    if (dim <= 3) return solve_with<3>(game, limits);
    if (dim <= 4) return solve_with<4>(game, limits);
    if (dim <= 5) return solve_with<5>(game, limits);
    if (dim <= 6) return solve_with<6>(game, limits);
    if (dim <= 8) return solve_with<8>(game, limits);
    if (dim <= 12) return solve_with<12>(game, limits);
    if (dim <= 20) return solve_with<20>(game, limits);
    if (dim <= 40) return solve_with<40>(game, limits);
    throw std::invalid_argument("more than 39 clocks");
}

}  // namespace

PYBIND11_MODULE(_core, module) {
    module.doc() = "Native engine of the timed game solver.";
    py::register_exception<Limit>(module, "LimitReached");
    module.attr("INF") = INF;
    module.def("solve", &solve, py::arg("game"), py::arg("seconds") = 0.0, py::arg("states") = 0,
               py::arg("memory_mib") = 0, py::arg("progress") = py::none(),
               "Decides a compiled game. Raises LimitReached('seconds', 'states' or 'memory').");
}
