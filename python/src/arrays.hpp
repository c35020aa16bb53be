#pragma once
// Exchange of arrays with NumPy: results are views without a copy; inputs are checked.

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "firmware/physics/types.hpp"
#include "host/lab/outcome.hpp"

namespace ligature::python {

namespace nb = nanobind;

template <class T, class... Shape>
using View = nb::ndarray<nb::numpy, const T, nb::c_contig, Shape...>;
using Points = View<double, nb::shape<-1, 3>>;

inline std::array<double, 3> plain(const physics::Vec3& v) { return {v.x(), v.y(), v.z()}; }

/// Read-only n x 3 view of memory that `owner` keeps alive.
inline Points points_view(std::span<const physics::Vec3> points, nb::handle owner) {
  static_assert(sizeof(physics::Vec3) == 3 * sizeof(double));
  return Points(points.empty() ? nullptr : points.front().data(), {points.size(), 3}, owner);
}

/// An array that owns its data.
template <class T>
View<T> array_of(std::vector<T> values, std::initializer_list<std::size_t> shape) {
  auto kept = std::make_unique<std::vector<T>>(std::move(values));
  const T* data = kept->data();
  nb::capsule owner(kept.get(), [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  static_cast<void>(kept.release());
  return View<T>(data, shape, owner);
}

/// Numeric input from Python: an array or sequence that NumPy converts to doubles.
using Numbers = nb::ndarray<const double, nb::numpy, nb::c_contig, nb::device::cpu>;

/// `array` as rows of `columns` finite numbers with magnitude <= `most`. @throws lab::Refusal "NAME: found .., allowed
/// ..".
std::span<const double> rows_of(const Numbers& array, const char* name, std::size_t columns, double most);

}  // namespace ligature::python
