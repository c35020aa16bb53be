#include "host/lab/rerun/differences.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "host/thread_knot.hpp"
#include "host/tick_columns.hpp"
#include "host/tick_statistics.hpp"

namespace ligature::lab {
namespace {

using ligature_msg::thread_t;
using ligature_msg::tick_t;

constexpr double kKnotEvery_s = 0.1;

const std::vector<host::TickColumn>& columns() {
  static const std::vector<host::TickColumn> found = [] {
    std::vector<host::TickColumn> of;
    for (const auto& name : columns_of_thread()) {
      const auto at = std::ranges::find(host::tick_columns(), name, &host::TickColumn::name);
      if (at == host::tick_columns().end()) throw std::logic_error("no column " + name);
      of.push_back(*at);
    }
    return of;
  }();
  return found;
}

bool same_bits(const host::TickColumn& column, const tick_t& a, const tick_t& b) {
  if (const auto* whole = std::get_if<host::TickColumn::Whole>(&column.value)) return (*whole)(a) == (*whole)(b);
  const auto& real = std::get<host::TickColumn::Real>(column.value);
  return std::bit_cast<std::uint64_t>(real(a)) == std::bit_cast<std::uint64_t>(real(b));
}

std::string value_of(const host::TickColumn& column, const tick_t& tick) {
  std::ostringstream text;
  text.precision(17);
  std::visit([&](const auto& value) { text << value(tick); }, column.value);
  return text.str();
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
  return std::ranges::equal(a, b, {}, bits, bits);
}

bool same_bits(const thread_t& a, const thread_t& b) {
  return a.count == b.count && same_bits(a.tension_N, b.tension_N) && same_bits(a.turn_rad, b.turn_rad) &&
         std::ranges::equal(a.grasped_node, b.grasped_node) &&
         std::ranges::equal(a.p_W_m, b.p_W_m, [](const auto& p, const auto& q) { return same_bits(p, q); });
}

/// The point at a fraction 0 .. 1 (`share`) of the largest node index, interpolated linearly.
std::array<double, 3> point_at(const thread_t& thread, double share) {
  const double at = share * static_cast<double>(thread.p_W_m.size() - 1);
  const auto before = std::min(static_cast<std::size_t>(at), thread.p_W_m.size() - 2);
  const double on = at - static_cast<double>(before);
  std::array<double, 3> p{};
  for (std::size_t k = 0; k < 3; ++k)
    p[k] = (1.0 - on) * static_cast<double>(thread.p_W_m[before][k]) +
           on * static_cast<double>(thread.p_W_m[before + 1][k]);
  return p;
}

void note(KnotHistory& history, double t_s, const std::string& type) {
  if (history.empty() || history.back().second != type) history.emplace_back(t_s, type);
}

}  // namespace

const std::vector<std::string>& columns_of_thread() {
  static const std::vector<std::string> names{"left_world_f_x_N",  "left_world_f_y_N",  "left_world_f_z_N",
                                              "left_node",         "right_world_f_x_N", "right_world_f_y_N",
                                              "right_world_f_z_N", "right_node",        "kinetic_J",
                                              "potential_J",       "max_stretch",       "min_gap_m",
                                              "contacts",          "degradation",       "thread_end",
                                              "thread_cut_at",     "time_lost",         "flags",
                                              "left_propagation",  "right_propagation"};
  return names;
}

double apart_N(const tick_t& recorded, const tick_t& again, std::size_t hand) {
  double apart[3];
  for (std::size_t k = 0; k < 3; ++k) apart[k] = again.f_world_N[hand][k] - recorded.f_world_N[hand][k];
  return host::magnitude(apart);
}

void ForceOf::add(double force_N) {
  squares_N2 += force_N * force_N;
  peak_N = std::max(peak_N, force_N);
}

double ForceOf::rms_N(std::int64_t ticks) const {
  return ticks > 0 ? std::sqrt(squares_N2 / static_cast<double>(ticks)) : 0.0;
}

ShapeDistance distance(const thread_t& a, const thread_t& b) {
  ShapeDistance d;
  if (a.p_W_m.size() < 2 || b.p_W_m.size() < 2) return d;
  const double last = static_cast<double>(a.p_W_m.size() - 1);
  for (std::size_t i = 0; i < a.p_W_m.size(); ++i) {
    const auto p = point_at(a, static_cast<double>(i) / last), q = point_at(b, static_cast<double>(i) / last);
    const double off_m = std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
    d.rms_m += off_m * off_m;
    d.largest_m = std::max(d.largest_m, off_m);
  }
  d.rms_m = std::sqrt(d.rms_m / (last + 1.0));
  return d;
}

void Differences::add(const tick_t& recorded, const tick_t& again, std::optional<double> cost_us) {
  ++ticks_;
  const auto differs = std::ranges::find_if(columns(), [&](const auto& c) { return !same_bits(c, recorded, again); });
  if (differs != columns().end()) {
    ++different_ticks_;
    if (first_.empty())
      first_ = "tick " + std::to_string(recorded.tick) + ": " + differs->name + " " + value_of(*differs, recorded) +
               " recorded, " + value_of(*differs, again) + " now";
  }
  for (std::size_t h = 0; h < 2; ++h) {
    recorded_.force[h].add(host::magnitude(recorded.f_world_N[h]));
    again_.force[h].add(host::magnitude(again.f_world_N[h]));
    apart_[h].add(apart_N(recorded, again, h));
  }
  if ((recorded.flags & tick_t::FLAG_PERIOD_LOST) != 0) return;
  recorded_.lost_ticks += static_cast<double>(recorded.time_lost);
  again_.lost_ticks += static_cast<double>(again.time_lost);
  if (recorded.thread_work_ns > 0) recorded_.cost_us.push_back(1e-3 * recorded.thread_work_ns);
  if (cost_us) again_.cost_us.push_back(*cost_us);
}

void Differences::add(const thread_t& recorded, const thread_t& again) {
  ++shapes_;
  const bool same = same_bits(recorded, again);
  if (!same) {
    ++different_shapes_;
    if (first_.empty()) first_ = "tick " + std::to_string(recorded.tick) + ": the shape";
    const auto off = distance(recorded, again);
    shape_squares_m2_ += off.rms_m * off.rms_m;
    if (off.largest_m > shape_largest_m_) shape_largest_m_ = off.largest_m, shape_largest_at_s_ = time_s(recorded.tick);
  }
  name_knots(recorded, again, same);
}

void Differences::name_knots(const thread_t& recorded, const thread_t& again, bool same) {
  if (recorded.tick < knot_due_tick_ || recorded.p_W_m.size() < 3 || again.p_W_m.size() < 3) return;
  knot_due_tick_ = recorded.tick + std::llround(kKnotEvery_s / period_s_);
  const auto type = host::name_knot(recorded).type;
  note(recorded_.knots, time_s(recorded.tick), type);
  note(again_.knots, time_s(recorded.tick), same ? type : host::name_knot(again).type);
}

double Differences::shape_rms_m() const {
  return shapes_ > 0 ? std::sqrt(shape_squares_m2_ / static_cast<double>(shapes_)) : 0.0;
}

}  // namespace ligature::lab
