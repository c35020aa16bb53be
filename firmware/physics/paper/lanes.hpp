#pragma once
// Arrays of one number per node, with zeros before the first and after the last node. So loops over packs of four nodes
// need no special cases at the ends: they may read one node before the first, and read and write several past the last.

#include <cstddef>
#include <vector>

#include "firmware/physics/members.hpp"
#include "firmware/physics/v3.hpp"

namespace ligature::physics {

class Lane {
 public:
  Lane() = default;
  explicit Lane(int count) : numbers_(static_cast<std::size_t>(count) + kFront + kBack, 0.0) {}

  double* data() noexcept { return numbers_.data() + kFront; }
  const double* data() const noexcept { return numbers_.data() + kFront; }
  double& operator[](int i) noexcept { return data()[i]; }
  double operator[](int i) const noexcept { return data()[i]; }
  Pack pack(int i) const noexcept { return load(data() + i); }
  void set(int i, Pack a) noexcept { store(data() + i, a); }
  LIGATURE_MEMBERS(Lane, numbers)

 private:
  static constexpr std::size_t kFront = 4, kBack = 12;
  std::vector<double> numbers_;
};

struct Lane3 {
  Lane x, y, z;
  Lane3() = default;
  explicit Lane3(int count) : x(count), y(count), z(count) {}
  LIGATURE_MEMBERS(Lane3, a, b, c)

  V3<Pack> pack(int i) const noexcept { return {x.pack(i), y.pack(i), z.pack(i)}; }
  void set(int i, const V3<Pack>& a) noexcept { x.set(i, a.x), y.set(i, a.y), z.set(i, a.z); }
  V3<double> at(int i) const noexcept { return {x[i], y[i], z[i]}; }
  void put(int i, const V3<double>& a) noexcept { x[i] = a.x, y[i] = a.y, z[i] = a.z; }
};

}  // namespace ligature::physics
