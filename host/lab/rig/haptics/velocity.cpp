// Tests the firmware's velocity estimator on encoder counts: its noise at constant speed and its lag under
// acceleration, compared with a simple difference and a low-pass.

#include <cmath>
#include <random>

#include "firmware/control/window_velocity.hpp"
#include "host/lab/rig/haptics/haptics.hpp"
#include "host/lab/run_files.hpp"
#include "protocol/device/device.hpp"

namespace ligature::lab {
namespace {

constexpr double kT_s = 1e-3;

/// Two simple velocity estimates for comparison: the backward difference, raw and after a first-order low-pass at 35
/// Hz.
struct Plain {
  double last = 0.0, raw = 0.0, filtered = 0.0;
  bool seeded = false;
  void add(double x) {
    if (seeded) raw = (x - last) / kT_s;
    filtered += 0.2 * (raw - filtered);
    last = x;
    seeded = true;
  }
};

struct Errors {
  double window = 0.0, raw = 0.0, filtered = 0.0;
};

/// rms errors of the three estimates for v(t) = v0 + a t at the tip, from positions rounded to quantum_m. The start is
/// skipped.
Errors rms(double v0, double a, double quantum_m, double& mean_window_error) {
  std::mt19937 random(7);
  Errors sum;
  long count = 0;
  mean_window_error = 0.0;
  for (int run = 0; run < 20; ++run) {
    control::WindowVelocity window(kT_s, quantum_m);
    Plain plain;
    const double offset = quantum_m * static_cast<double>(random()) * 0x1p-32;
    for (int n = 0; n < 400; ++n) {
      const double t = n * kT_s, truth = v0 + a * t;
      const double counted = quantum_m * std::round((offset + v0 * t + 0.5 * a * t * t) / quantum_m);
      window.add(counted, 1);
      plain.add(counted);
      if (n < 50) continue;
      sum.window += std::pow(window.velocity_per_s() - truth, 2);
      sum.raw += std::pow(plain.raw - truth, 2);
      sum.filtered += std::pow(plain.filtered - truth, 2);
      mean_window_error += window.velocity_per_s() - truth;
      ++count;
    }
  }
  const double n = static_cast<double>(count);
  mean_window_error /= n;
  return {std::sqrt(sum.window / n), std::sqrt(sum.raw / n), std::sqrt(sum.filtered / n)};
}

}  // namespace

void measure_velocity(const HapticsBench& bench, Verdict& v) {
  const auto& device = device::omni();
  const double quantum_m = device.rad_per_count() * device.links_m[1];
  Table table({"speed_mm_per_s", "accel_m_per_s2", "window_rms_mm_per_s", "difference_rms_mm_per_s",
               "lowpass_rms_mm_per_s", "window_lag_ms"});
  double slow_window = 0.0, slow_filtered = 0.0, lag_ms = 0.0;
  for (const auto& [speed, accel] : {std::pair{0.0, 0.0},
                                     {0.003, 0.0},
                                     {0.01, 0.0},
                                     {0.03, 0.0},
                                     {0.1, 0.0},
                                     {0.3, 0.0},
                                     {0.0, 0.5},
                                     {0.0, 2.0},
                                     {0.0, 10.0}}) {
    double bias = 0.0;
    const Errors e = rms(speed, accel, quantum_m, bias);
    const double lag = accel > 0.0 ? -1e3 * bias / accel : 0.0;
    table.row({1e3 * speed, accel, 1e3 * e.window, 1e3 * e.raw, 1e3 * e.filtered, lag});
    if (speed == 0.01) slow_window = e.window, slow_filtered = e.filtered;
    if (accel == 10.0) lag_ms = lag;
  }
  table.print();
  table.write(bench.out / "haptics-velocity.csv");
  v.claim(slow_window < 0.006,
          "Velocity: rms error at 10 mm/s (low-pass at 35 Hz: " + digits(1e3 * slow_filtered) + "), mm/s",
          digits(1e3 * slow_window), "below 6");
  v.claim(lag_ms < 4.0, "Velocity: lag at 10 m/s2 (low-pass: 4), ms", digits(lag_ms), "below 4");
}

}  // namespace ligature::lab
