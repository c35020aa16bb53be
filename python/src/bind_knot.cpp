#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "host/knot/recognise.hpp"
#include "python/src/arrays.hpp"
#include "python/src/bindings.hpp"

namespace ligature::python {
namespace {

constexpr double kMost_m = 1e9;
constexpr std::size_t kMostPoints = 20'000;  // the cost is quadratic

knot::KnotResult name_knot(const Numbers& array, bool closed) {
  const auto values = rows_of(array, "points", 3, kMost_m);
  if (values.size() > 3 * kMostPoints)
    throw lab::Refusal("points: found " + std::to_string(values.size() / 3) + ", allowed 20000 at most");
  std::vector<std::array<double, 3>> points;
  for (std::size_t i = 0; i < values.size(); i += 3) points.push_back({values[i], values[i + 1], values[i + 2]});
  const nb::gil_scoped_release free;
  return knot::recognise(points, closed);
}

}  // namespace

void bind_knot(nb::module_& module) {
  nb::class_<knot::KnotResult>(module, "Knot", "Result of ligature.knot.")
      .def_ro("type", &knot::KnotResult::type,
              "Type: '0_1', '3_1', '3_1#3_1', ..; 'unknown' if it could not be determined.")
      .def_ro("handedness", &knot::KnotResult::handedness, "'right', 'left', 'amphichiral', 'mixed' or 'none'.")
      .def_prop_ro(
          "determinant",
          [](const knot::KnotResult& k) {
            return k.alexander.empty() ? nb::object(nb::none()) : nb::object(nb::int_(k.determinant));
          },
          nb::sig("def determinant(self) -> int | None"),
          "Knot determinant |Delta(-1)|; None if it could not be computed.")
      .def_ro("alexander", &knot::KnotResult::alexander,
              "Coefficients of the Alexander polynomial from t^0 up, the first one positive; empty as above.")
      .def_ro("crossings", &knot::KnotResult::crossings, "Crossings of the simplest diagram that was found.");
  module.def("knot", &name_knot, nb::arg("points"), nb::arg("closed") = false,
             "Names the knot in a polyline.\n\n"
             "points: n x 3, m, in order along the thread, at most 20000. closed: the last point is joined to the "
             "first;\nelse the thread is open and closed as `ligature-host knot` does it.\n"
             "Raises Refusal for another shape, or a coordinate that is no number or beyond 1e9.\n"
             "Cost: about 1 ms for 500 points. Source: host/knot/recognise.hpp.");
}

}  // namespace ligature::python
