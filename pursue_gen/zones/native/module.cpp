// The native zone library in Python, for tests: the same names as pursue_gen/zones/dbm.py and federation.py have.
//
// Two sizes are bound: short bounds without padding, and long ones with clocks that are padding, as engines use both.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <optional>
#include <stdexcept>
#include <string>

#include "zones/native/federation.hpp"

namespace py = pybind11;
using namespace pursue;

namespace {

// What the Python side writes for no bound.
constexpr std::int32_t UNBOUNDED = 1 << 30;

// A zone of `dim` - 1 clocks; those of Z beyond are padding.
template <class Z>
struct Zone {
    int dim;
    Z z;

    Zone(int dim, const Z& z) : dim(dim), z(z) {}

    // Raises ValueError for a matrix that is not canonical, or too large for Z.
    Zone(int dim, const std::vector<std::int32_t>& m) : dim(dim), z(universe<Z>()) {
        if (dim < 1 || dim > Z::size || m.size() != static_cast<std::size_t>(dim * dim))
            throw std::invalid_argument("expected a matrix of at most " + std::to_string(Z::size) + " rows");
        for (int i = 0; i < dim; ++i)
            for (int j = 0; j < dim; ++j) z.at(i, j) = bound(m[i * dim + j]);
        if (!close(z) || matrix() != m) throw std::invalid_argument("the matrix is not canonical");
    }

    static typename Z::raw_t bound(std::int32_t raw) {
        return raw >= UNBOUNDED ? INF<typename Z::raw_t> : static_cast<typename Z::raw_t>(raw);
    }

    std::vector<std::int32_t> matrix() const {
        std::vector<std::int32_t> out;
        for (int i = 0; i < dim; ++i)
            for (int j = 0; j < dim; ++j) out.push_back(z.at(i, j) >= INF<typename Z::raw_t> ? UNBOUNDED : z.at(i, j));
        return out;
    }

    // What `change` makes of a copy: changed in place, or nothing where it returns false.
    template <class F>
    std::optional<Zone> maybe(F change) const {
        Zone copy = *this;
        if (!change(copy.z)) return std::nullopt;
        return copy;
    }

    template <class F>
    Zone with(F change) const {
        Zone copy = *this;
        change(copy.z);
        return copy;
    }
};

template <class Z>
using Zones = std::vector<Zone<Z>>;

template <class Z>
Federation<Z> plain(const Zones<Z>& zones) {
    Federation<Z> out;
    for (const auto& zone : zones) out.push_back(zone.z);
    return out;
}

template <class Z>
Zones<Z> bound(const Federation<Z>& fed, int dim) {
    Zones<Z> out;
    for (const auto& z : fed) out.emplace_back(dim, z);
    return out;
}

template <class Z>
int dim_of(const Zones<Z>& a, const Zones<Z>& b) {
    return !a.empty() ? a[0].dim : !b.empty() ? b[0].dim : 1;
}

template <class Z>
void bind_dbm(py::module_& module) {
    using D = Zone<Z>;
    py::class_<D>(module, "Dbm")
        .def(py::init<int, std::vector<std::int32_t>>(), py::arg("dim"), py::arg("m"))
        .def_readonly("dim", &D::dim)
        .def_property_readonly("m", [](const D& d) { return py::tuple(py::cast(d.matrix())); })
        .def("__eq__", [](const D& a, const D& b) { return a.dim == b.dim && a.matrix() == b.matrix(); })
        .def_static("universe", [](int dim) { return D(dim, universe<Z>()); })
        .def_static("zero", [](int dim) { return D(dim, origin<Z>(dim - 1)); })
        .def("is_canonical", [](const D& d) { return is_canonical(d.z); })
        .def("constrained", [](const D& d, int i, int j, std::int32_t raw) {
            return d.maybe([&](Z& z) { return constrain(z, i, j, D::bound(raw)); });
        })
        .def("is_disjoint", [](const D& a, const D& b) { return clearly_disjoint(a.z, b.z); })
        .def("intersect", [](const D& a, const D& b) { return a.maybe([&](Z& z) { return intersect(z, b.z); }); })
        .def("includes", [](const D& a, const D& b) { return includes(a.z, b.z); })
        .def("hull", [](const D& a, const D& b) { return D(a.dim, hull(a.z, b.z)); })
        .def("joined", [](const D& a, const D& b) -> std::optional<D> {
            if (!joins(a.z, b.z)) return std::nullopt;
            return D(a.dim, hull(a.z, b.z));
        })
        .def("minus", [](const D& a, const D& b) { return bound(minus(Federation<Z>{a.z}, b.z), a.dim); })
        .def("boxed", [](const D& d, const Zones<Z>& parts) { return D(d.dim, boxed(d.z, plain(parts))); })
        .def("around", [](const D& a, const D& b) { return bound(around(a.z, b.z), a.dim); })
        .def("up", [](const D& d) { return d.with([](Z& z) { up(z); }); })
        .def("down", [](const D& d) { return d.with([](Z& z) { down(z); }); })
        .def("up_within", [](const D& d, int delay) { return d.with([&](Z& z) { up_within(z, delay); }); })
        .def("down_within", [](const D& d, int delay) { return d.with([&](Z& z) { down_within(z, delay); }); })
        .def("reset", [](const D& d, const std::vector<int>& clocks) {
            return d.with([&](Z& z) { for (int x : clocks) reset(z, x); });
        })
        .def("before_reset", [](const D& d, const std::vector<int>& clocks) {
            return d.maybe([&](Z& z) {
                for (int x : clocks)
                    if (!constrain(z, x, 0, LE_ZERO)) return false;
                for (int x : clocks) free_clock(z, x);
                return true;
            });
        })
        .def("extrapolated", [](const D& d, std::vector<wide_t> max) {
            max.resize(Z::size, -1);
            return d.with([&](Z& z) { extrapolate(z, max); });
        });
}

template <class Z>
void bind_federation(py::module_& module) {
    using F = Zones<Z>;
    module.def("minus", [](const F& a, const F& b) { return bound(minus(plain(a), plain(b)), dim_of(a, b)); });
    module.def("intersection", [](const F& a, const F& b) { return bound(intersection(plain(a), plain(b)), dim_of(a, b)); });
    module.def("inserted", [](const F& a, const Zone<Z>& zone) {
        Federation<Z> fed = plain(a);
        insert(fed, zone.z);
        return bound(fed, zone.dim);
    });
    module.def("reduced", [](const F& a) { return bound(reduced(plain(a)), dim_of(a, a)); });
    module.def("disjoint", [](const F& a) { return bound(disjoint(plain(a)), dim_of(a, a)); });
    module.def("touches", [](const F& a, const Zone<Z>& zone) { return touches(plain(a), zone.z); });
    module.def("contains", [](const F& a, const Zone<Z>& zone) { return contains(plain(a), zone.z); });
    module.def("predt", [](const F& good, const F& bad) { return bound(predt(plain(good), plain(bad)), dim_of(good, bad)); });
    module.def("lasting", [](const F& a, int delay) { return bound(lasting(plain(a), delay), dim_of(a, a)); });
}

[[noreturn]] void enough(void*) { throw std::runtime_error("enough"); }

// Calls a function that may look at so many zones, or whose zones do not count (0), and that is looked after so often at
// most; raises RuntimeError where it is more.
py::object within_effort(std::uint64_t zones, std::uint64_t looks, const py::function& function) {
    struct Guard {
        ~Guard() { effort = Effort{}; }
    } const guard;
    effort = Effort{};
    effort.due = zones ? zones : 1;
    effort.pause = enough;
    effort.look = [](void* left) {
        if ((*static_cast<std::uint64_t*>(left))-- == 0) enough(left);
    };
    effort.of = &looks;
    if (zones) return function();
    const Uncounted all;
    return function();
}

}  // namespace

PYBIND11_MODULE(_zones, module) {
    module.doc() = "The native zone library, for tests.";
    module.def("within_effort", &within_effort, py::arg("zones"), py::arg("looks"), py::arg("function"));
    py::module_ narrow = module.def_submodule("short", "16-bit bounds, three clocks.");
    py::module_ wide = module.def_submodule("long", "32-bit bounds, seven clocks.");
    bind_dbm<Dbm<4, std::int16_t>>(narrow);
    bind_federation<Dbm<4, std::int16_t>>(narrow);
    bind_dbm<Dbm<8, wide_t>>(wide);
    bind_federation<Dbm<8, wide_t>>(wide);
}
