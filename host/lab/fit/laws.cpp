#include "host/lab/fit/laws.hpp"

#include <cmath>
#include <numbers>

#include "host/lab/fit/shapes.hpp"
#include "host/lab/report.hpp"

namespace ligature::fit {
namespace {

using Row = std::span<const double>;
using Out = std::span<double>;

std::string possible(Row) { return {}; }

void weighed(const Parameters& p, Row row, Out out) { out[0] = std::log(p[kDensity] * row[0] / row[1]); }

void stretched(const Parameters& p, Row row, Out out) {
  out[0] = (p[kNatural] * (1.0 + row[0] / p[kEA]) - row[1]) / row[1];
}

// row: angle, smaller and larger tension
void dragged(const Parameters& p, Row row, Out out) {
  out[0] = p[kFriction] * row[0] * std::numbers::pi / 180.0 - std::log(row[2] / row[1]);
}
std::string drag_refused(Row row) {
  if (row[2] > row[1]) return {};
  return "column 'high_N': found " + lab::digits(row[2]) + ", allowed above low_N, which is " + lab::digits(row[1]);
}

void sagged(const Parameters& p, Row row, Out out) {
  const double w = p[kDensity] * kGravity_m_per_s2;
  out[0] = sag_over_length(w * std::pow(row[0], 3) / p[kEI]) - row[1] / row[0];
}
std::string sag_refused(Row row) {
  if (row[1] < row[0]) return {};
  return "column 'sag_m': found " + lab::digits(row[1]) + ", allowed below length_m, which is " + lab::digits(row[0]);
}

// row: length, number of swings, time for them, amplitude at their start and end
void swung(const Parameters& p, Row row, Out out) {
  const auto swing = swing_of({row[0], p[kEI], p[kDensity], p[kBendDamping], p[kDrag]});
  // A thread that does not oscillate has an infinite period; a large finite residual leads the fit away from such
  // threads.
  out[0] = std::isfinite(swing.period_s) ? std::log(swing.period_s * row[1] / row[2]) : 10.0;
  out[1] = swing.decay_per_s * row[2] - std::log(row[3] / row[4]);
}
std::string swing_refused(Row row) {
  if (row[4] < row[3]) return {};
  return "column 'end_m': found " + lab::digits(row[4]) + ", allowed below start_m, which is " + lab::digits(row[3]);
}

}  // namespace

const std::vector<Law>& laws() {
  static const std::vector<Law> all{
      {"weigh",
       "length_m,mass_kg",
       "weigh pieces of known length",
       {{"length_m", 1e-4, 1e4}, {"mass_kg", 1e-9, 1e4}},
       {kDensity},
       {},
       3,
       {"mass, relative"},
       possible,
       weighed},
      {"load",
       "load_N,length_m",
       "hang weights on a piece and measure the distance of two marks",
       {{"load_N", 0.0, 1e6}, {"length_m", 1e-4, 1e4}},
       {kNatural, kEA},
       {},
       3,
       {"length, relative"},
       possible,
       stretched},
      {"drag",
       "angle_deg,low_N,high_N",
       "pull one end over a peg, or over the thread itself, while a weight hangs on the other",
       {{"angle_deg", 1.0, 1e5}, {"low_N", 1e-6, 1e6}, {"high_N", 1e-6, 1e6}},
       {kFriction},
       {},
       3,
       {"ln(high/low)"},
       drag_refused,
       dragged},
      {"sag",
       "length_m,sag_m",
       "clamp one end level and measure how far the free end sinks",
       {{"length_m", 1e-4, 1e4}, {"sag_m", 1e-6, 1e4}},
       {kEI},
       {kDensity},
       3,
       {"sag / length"},
       sag_refused,
       sagged},
      {"swing",
       "length_m,swings,time_s,start_m,end_m",
       "hang it from a clamp, let it swing, and film it",
       {{"length_m", 1e-4, 1e4},
        {"swings", 0.5, 1e4},
        {"time_s", 1e-4, 1e4},
        {"start_m", 1e-6, 1e4},
        {"end_m", 1e-6, 1e4}},
       {kEI, kBendDamping, kDrag},
       {kDensity},
       3,
       {"period, relative", "ln(start/end)"},
       swing_refused,
       swung}};
  return all;
}

}  // namespace ligature::fit
