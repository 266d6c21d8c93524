// The Python face of the native checker: tables of a network and a strategy, and what is done with them (see
// closed_loop.py).
#include <pybind11/functional.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "proof/native/search.hpp"
#include "proof/native/simplify.hpp"
#include "zones/native/memory.hpp"

namespace py = pybind11;
using namespace pursue;
using namespace pursue::proof;

namespace {

// What the Python side writes for no bound.
constexpr std::int64_t UNBOUNDED = std::int64_t{1} << 62;

std::vector<Bound> read_bounds(const py::handle& list) {
    std::vector<Bound> out;
    for (const auto& [i, j, raw] : list.cast<std::vector<std::tuple<int, int, std::int64_t>>>()) out.push_back({i, j, raw});
    return out;
}

std::vector<Test> read_tests(const py::handle& list) {
    std::vector<Test> out;
    for (const auto& [variable, value] : list.cast<std::vector<std::pair<int, int>>>()) out.push_back({variable, value});
    return out;
}

Network read_network(const py::dict& in) {
    Network out;
    out.dim = in["clocks"].cast<int>() + 1;
    out.initial = in["initial"].cast<Discrete>();
    for (const auto& a : in["automata"]) {
        Automaton automaton;
        for (const auto& location : a["invariants"]) automaton.invariants.push_back(read_bounds(location));
        automaton.leaving = a["leaving"].cast<std::vector<std::vector<int>>>();
        out.automata.push_back(std::move(automaton));
    }
    for (const auto& e : in["edges"]) {
        Edge edge;
        edge.kind = e["kind"].cast<int>();
        edge.source = e["source"].cast<int>();
        edge.target = e["target"].cast<int>();
        edge.guard = read_bounds(e["guard"]);
        for (const auto& clause : e["clauses"]) edge.clauses.push_back(read_tests(clause));
        edge.channel = e["channel"].cast<int>();
        edge.sends = e["sends"].cast<bool>();
        edge.assign = read_tests(e["assign"]);
        edge.resets = e["resets"].cast<std::vector<int>>();
        edge.controllable = e["controllable"].cast<bool>();
        out.edges.push_back(std::move(edge));
    }
    return out;
}

Strategy read_strategy(const py::list& blocks, const py::list& constraints) {
    Strategy out;
    out.constraints = read_bounds(constraints);
    int first = 0;
    for (const auto& item : blocks) {
        const auto parts = item.cast<py::tuple>();
        BlockTable block;
        block.first = first;
        block.wait = parts[1].cast<std::vector<ZoneTable>>();
        first += static_cast<int>(block.wait.size());
        for (const auto& each : parts[2]) {
            auto [move, zones] = each.cast<std::pair<std::vector<int>, std::vector<ZoneTable>>>();
            first += static_cast<int>(zones.size());
            block.commands.push_back({std::move(move), std::move(zones)});
        }
        if (!parts[0].is_none()) {  // none: not a discrete state of this network
            block.state = parts[0].cast<Discrete>();
            out.of_state[block.state].push_back(static_cast<int>(out.blocks.size()));
        }
        out.blocks.push_back(std::move(block));
    }
    return out;
}

// Gives Python a chance to end the work: signals, limits. It runs without the interpreter's lock.
Watch::Poll polling(const py::function& poll) {
    return [&poll](std::size_t states, std::size_t waiting) {
        const py::gil_scoped_acquire locked;
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        poll(states, waiting);
    };
}

// Calls f with a zone type that has room for the clocks, with 32-bit bounds, or 64-bit ones if `wide` is set. The solver
// holds up to 127 clocks; with one that counts from the start there are 128.
template <class F>
auto with_zones(int dim, bool wide, F f) {
#ifndef PURSUE_ONE_SIZE  // as in the solver
    if (!wide) {
        if (dim <= 4) return f(Dbm<4, std::int32_t>{});
        if (dim <= 8) return f(Dbm<8, std::int32_t>{});
        if (dim <= 12) return f(Dbm<12, std::int32_t>{});
        if (dim <= 16) return f(Dbm<16, std::int32_t>{});
    }
    if (dim <= 8) return f(Dbm<8, std::int64_t>{});
    if (dim <= 16) return f(Dbm<16, std::int64_t>{});
#endif
    if (dim <= 40) return f(Dbm<40, std::int64_t>{});
#ifndef PURSUE_ONE_SIZE
    if (dim <= 64) return f(Dbm<64, std::int64_t>{});
    if (dim <= 96) return f(Dbm<96, std::int64_t>{});
#endif
    if (dim <= 136) return f(Dbm<136, std::int64_t>{});
    throw std::overflow_error("more than 135 clocks");
}

template <class Z>
Z read_zone(const std::vector<std::int64_t>& matrix, int dim) {
    Z zone = universe<Z>();
    for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) {
            const std::int64_t raw = matrix[i * dim + j];
            if (raw < UNBOUNDED && (raw >= INF<typename Z::raw_t> || raw <= -INF<typename Z::raw_t>))
                throw std::overflow_error("the start is too large");
            zone.at(i, j) = raw >= UNBOUNDED ? INF<typename Z::raw_t> : static_cast<typename Z::raw_t>(raw);
        }
    free_padding(zone, dim);
    return zone;
}

template <class Z>
std::vector<std::int64_t> matrix(const Z& zone, int dim) {
    std::vector<std::int64_t> out;
    for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) {
            const auto raw = zone.at(i, j);
            out.push_back(raw >= INF<typename Z::raw_t> ? UNBOUNDED : static_cast<std::int64_t>(raw));
        }
    return out;
}

Places read_places(const py::handle& list) {
    Places out;
    for (const auto& [automaton, location] : list.cast<std::vector<std::pair<int, int>>>())
        out.push_back({automaton, location});
    return out;
}

// How a strategy is played, and for what.
struct Settings {
    std::int64_t factor;
    Rules rules;
    Places goal, bad;
    std::optional<Ranks> ranks;
};

Settings read_settings(const py::dict& in) {
    return {in["factor"].cast<std::int64_t>(),
            {in["reaction"].cast<int>(), false, in["must_end"].cast<bool>(), in["instant"].cast<int>()},
            read_places(in["goal"]),
            read_places(in["bad"]),
            in["ranks"].cast<std::optional<Ranks>>()};
}

// What a search has to do, from where, and how.
struct Task {
    std::string search;
    Discrete state;
    std::vector<std::int64_t> zone;
    bool prompt, exact;
    std::size_t limit, many;
    int clock;
    std::optional<Place> left;
};

Task read_task(const py::dict& in) {
    const Places left = read_places(in["left"]);
    return {in["search"].cast<std::string>(),
            in["state"].cast<Discrete>(),
            in["zone"].cast<std::vector<std::int64_t>>(),
            in["prompt"].cast<bool>(),
            in["exact"].cast<bool>(),
            in["limit"].cast<std::size_t>(),
            in["many"].cast<std::size_t>(),
            in["clock"].cast<int>(),
            left.empty() ? std::nullopt : std::optional<Place>(left[0])};
}

// What a search found out, free of the type of zones.
struct Result {
    std::size_t states = 0;
    std::vector<int> used;
    std::optional<std::int64_t> number;  // of an invariant's zones, or the latest time
    int fault = -1;
    std::vector<std::vector<int>> steps;
    std::vector<int> step;  // the one that makes no progress
    Discrete state;
    std::vector<std::int64_t> zone;
};

// A closed loop with zones of some type.
class AnyLoop {
  public:
    virtual ~AnyLoop() = default;
    virtual Result search(const Task& task, const Watch::Poll& poll) = 0;
};

template <class Z>
class LoopOf : public AnyLoop {
  public:
    LoopOf(const Tables& tables, const Settings& settings)
        : loop_(tables, settings.factor, settings.rules, settings.goal, settings.bad,
                settings.ranks ? &*settings.ranks : nullptr, watch_) {
        if (std::max(settings.rules.reaction, settings.rules.instant) > Arena<Z>::most / 2)
            throw std::overflow_error("the reaction is too long");
    }

    Result search(const Task& task, const Watch::Poll& poll) override {
        watch_ = Watch(poll);
        const Watched watched(watch_);
        loop_.rules.prompt = task.prompt;
        const Entry<Z> start{loop_.arena.number(task.state), read_zone<Z>(task.zone, loop_.arena.dim)};
        Search<Z> search(loop_, constants_, start, task.exact, task.limit);
        Result out;
        if (task.search == "invariant") {
            if (const auto zones = search.invariant()) out.number = static_cast<std::int64_t>(*zones);
        } else if (task.search == "latest") {
            try {
                out.number = search.latest(task.clock, task.left, task.many, out.states);
            } catch (const Broken<Z>& broken) {
                out.fault = static_cast<int>(broken.fault);
            }
        } else {
            note(task.search == "ends" ? search.ends() : search.all(task.many), out);
        }
        for (std::size_t key = 0; key < loop_.used.size(); ++key)
            if (loop_.used[key]) out.used.push_back(static_cast<int>(key));
        return out;
    }

  private:
    void note(const Outcome<Z>& found, Result& out) const {
        out.states = found.states;
        for (const auto* step : found.steps) out.steps.push_back(step->edges);
        if (!found.failure) return;
        out.fault = static_cast<int>(found.failure->fault);
        out.state = loop_.arena.state(found.state);
        out.zone = matrix(found.failure->zone, loop_.arena.dim);
        if (found.failure->move) out.step = found.failure->move->edges;
    }

    Watch watch_;
    ClosedLoop<Z> loop_;
    std::optional<MaxConstants<Z>> constants_;
};

// A closed loop; what one search works out of it serves the next ones. The tables must outlive it.
class Loop {
  public:
    Loop(const Tables& tables, const py::dict& settings) : tables_(tables), settings_(read_settings(settings)) {}

    py::dict search(const py::dict& in, const py::function& poll) {
        const Task task = read_task(in);
        const Watch::Poll polled = polling(poll);
        Result found;
        {
            const py::gil_scoped_release unlocked;
            found = search_in_zones(task, polled);
        }
        py::dict out;
        out["states"] = found.states;
        out["used"] = found.used;
        out["number"] = found.number;
        out["fault"] = found.fault;
        out["steps"] = found.steps;
        out["step"] = found.step;
        out["state"] = found.state;
        out["zone"] = found.zone;
        return out;
    }

  private:
    // Where the times are too large for the zones it starts again with wider ones, and stays with these.
    Result search_in_zones(const Task& task, const Watch::Poll& poll) {
        if (!wide_) {
            try {
                return loop().search(task, poll);
            } catch (const std::overflow_error&) {
                loop_.reset();
                wide_ = true;
            }
        }
        return loop().search(task, poll);
    }

    AnyLoop& loop() {
        if (!loop_)
            loop_ = with_zones(tables_.network.dim, wide_, [&](auto z) -> std::unique_ptr<AnyLoop> {
                return std::make_unique<LoopOf<decltype(z)>>(tables_, settings_);
            });
        return *loop_;
    }

    const GivesBack memory_;
    const Tables& tables_;
    const Settings settings_;
    bool wide_ = false;
    std::unique_ptr<AnyLoop> loop_;
};

// Of each block the zones of each action, to wait first, as bounds; an empty list where the block stays as it is.
using Smaller = std::vector<std::vector<std::vector<std::vector<std::tuple<int, int, std::int64_t>>>>>;

template <class Z>
Smaller simplified(const Tables& tables, std::int64_t factor, int late, const std::optional<Ranks>& ranks, Watch& watch) {
    const int dim = tables.network.dim;
    const Arena<Z> arena(tables.network, factor);
    if (late > Arena<Z>::most / 2) throw std::overflow_error("the reaction is too long");
    Smaller out;
    for (const BlockTable& block : tables.strategy.blocks) {
        watch.tick();
        auto& smaller = out.emplace_back();
        Z invariant = universe<Z>();
        bool possible = true;
        for (std::size_t a = 0; a < tables.network.automata.size(); ++a)
            possible = possible && arena.take(invariant, tables.network.automata[a].invariants[block.state[a]]);
        if (!possible) continue;
        BlockZones<Z> zones(invariant, late, block.commands.size() + 1, dim, watch);
        int key = block.first;
        const auto add = [&](std::size_t action, const std::vector<ZoneTable>& some) {
            for (const ZoneTable& table : some) {
                Z zone = invariant;
                std::vector<Bound> bounds;
                for (int c : table) bounds.push_back(tables.strategy.constraints[c]);
                if (arena.take(zone, bounds)) zones.add(action, zone, ranks ? (*ranks)[key] : BlockZones<Z>::unknown);
                ++key;
            }
        };
        add(0, block.wait);
        for (std::size_t k = 0; k < block.commands.size(); ++k) add(k + 1, block.commands[k].zones);
        zones.simplify();
        for (const auto& parts : zones.parts) {
            auto& action = smaller.emplace_back();
            for (const auto& part : parts) {
                auto& bounds = action.emplace_back();
                for (const Bound& b : part.bounds) bounds.emplace_back(b.i, b.j, b.raw);
            }
        }
    }
    return out;
}

py::object simplify(const Tables& tables, std::int64_t factor, int late, const std::optional<Ranks>& ranks,
                    const py::function& poll) {
    Watch watch(polling(poll));
    const Watched watched(watch);
    Smaller found;
    const auto with = [&](bool wide) {
        return with_zones(tables.network.dim, wide,
                          [&](auto z) { return simplified<decltype(z)>(tables, factor, late, ranks, watch); });
    };
    {
        const py::gil_scoped_release unlocked;
        try {
            found = with(false);
        } catch (const std::overflow_error&) {
            found = with(true);
        }
    }
    return py::cast(found);
}

}  // namespace

PYBIND11_MODULE(_proof, module) {
    keep_what_is_freed();
    module.doc() = "The native checker of strategies.";
    py::class_<Tables>(module, "Tables", "A network and a strategy, as tables.py makes them.")
        .def(py::init([](const py::dict& network, const py::list& blocks, const py::list& constraints) {
            return Tables{read_network(network), read_strategy(blocks, constraints)};
        }));
    py::class_<Loop>(module, "Loop", "A closed loop, played as closed_loop.py says.")
        .def(py::init<const Tables&, const py::dict&>(), py::arg("tables"), py::arg("settings"), py::keep_alive<1, 2>())
        .def("search", &Loop::search, py::arg("task"), py::arg("poll"),
             "Searches the loop. Raises OverflowError where times or clocks do not fit, and what `poll` raises.");
    module.def("simplify", &simplify, py::arg("tables"), py::arg("factor"), py::arg("late"), py::arg("ranks"),
               py::arg("poll"), "The strategy's zones, simplified. Raises as a search does.");
}
