#pragma once
// Differences between the recorded thread and the recomputed one.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/lab/statistics.hpp"
#include "ligature_msg/thread_t.hpp"
#include "ligature_msg/tick_t.hpp"

namespace ligature::lab {

/// The columns of a tick (host/tick_columns.hpp) that come from the thread. All are recorded exactly, except:
/// min_gap_m is 1e9 when nothing is near, contacts is clipped to 32767, time_lost is rounded to a float.
[[nodiscard]] const std::vector<std::string>& columns_of_thread();

/// Magnitude of the difference of the thread's forces on a hand, N.
[[nodiscard]] double apart_N(const ligature_msg::tick_t& recorded, const ligature_msg::tick_t& again, std::size_t hand);

/// Root mean square and maximum of a force, N.
struct ForceOf {
  double squares_N2 = 0.0, peak_N = 0.0;
  void add(double force_N);
  [[nodiscard]] double rms_N(std::int64_t ticks) const;
};

/// The knots over time: (time in s, type), one entry per change.
using KnotHistory = std::vector<std::pair<double, std::string>>;

/// Distance between two shapes, node by node, m. With different numbers of nodes, points at equal fractions of the node
/// index are compared.
struct ShapeDistance {
  double rms_m = 0.0, largest_m = 0.0;
};
[[nodiscard]] ShapeDistance distance(const ligature_msg::thread_t& a, const ligature_msg::thread_t& b);

/// Compares recorded and recomputed ticks and shapes.
class Differences {
 public:
  explicit Differences(double period_s) : period_s_(period_s) {}

  void add(const ligature_msg::tick_t& recorded, const ligature_msg::tick_t& again, std::optional<double> cost_us);
  void add(const ligature_msg::thread_t& recorded, const ligature_msg::thread_t& again);

  [[nodiscard]] bool are_none() const { return different_ticks_ + different_shapes_ == 0; }
  /// The first difference, such as "tick 1201: left_world_f_x_N 0.25 recorded, 0.26 now"; empty: none.
  [[nodiscard]] const std::string& first() const { return first_; }

  struct Side {
    std::array<ForceOf, 2> force;
    double lost_ticks = 0.0;
    std::vector<double> cost_us;
    KnotHistory knots;
  };
  [[nodiscard]] const Side& recorded() const { return recorded_; }
  [[nodiscard]] const Side& again() const { return again_; }
  /// |recorded - recomputed force|, per hand
  [[nodiscard]] const std::array<ForceOf, 2>& apart() const { return apart_; }
  [[nodiscard]] std::int64_t ticks() const { return ticks_; }
  [[nodiscard]] std::int64_t different_ticks() const { return different_ticks_; }
  [[nodiscard]] std::int64_t shapes() const { return shapes_; }
  [[nodiscard]] std::int64_t different_shapes() const { return different_shapes_; }
  [[nodiscard]] double shape_rms_m() const;
  [[nodiscard]] double shape_largest_m() const { return shape_largest_m_; }
  [[nodiscard]] double shape_largest_at_s() const { return shape_largest_at_s_; }

 private:
  [[nodiscard]] double time_s(std::int64_t tick) const { return static_cast<double>(tick) * period_s_; }
  void name_knots(const ligature_msg::thread_t& recorded, const ligature_msg::thread_t& again, bool same);

  double period_s_;
  Side recorded_, again_;
  std::array<ForceOf, 2> apart_;
  std::int64_t ticks_ = 0, different_ticks_ = 0, shapes_ = 0, different_shapes_ = 0, knot_due_tick_ = 0;
  double shape_squares_m2_ = 0.0, shape_largest_m_ = 0.0, shape_largest_at_s_ = 0.0;
  std::string first_;
};

}  // namespace ligature::lab
