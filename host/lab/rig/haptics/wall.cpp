#include "host/lab/rig/haptics/wall.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "firmware/control/passivity.hpp"
#include "host/lab/validate/proceed.hpp"

namespace ligature::lab {
namespace {

constexpr double kT_s = 1e-3;
constexpr double kWindow_s = 0.5;

/// A device with unit geometry: torque equals force and joint angle equals metres, so that one controller joint is the
/// axis of this test.
device::Device one_axis(device::Device d) {
  d.kinematics = device::Kinematics::kCartesian;
  d.links_m = {1, 1, 1};
  d.home_tip_m = {0, 0, 0};
  return d;
}

/// A mass with spring and damper. move() integrates m v' = F - k x - b v over one period with constant F: exactly for
/// k = 0, otherwise in small steps, each exact for constant k x.
struct Mass {
  double m, b, k;
  double x, v = 0.0;

  void move(double F) {
    const int steps = k > 0.0 ? 20 : 1;
    const double h = kT_s / steps, decay = std::exp(-b / m * h);
    for (int i = 0; i < steps; ++i) {
      const double end = (F - k * x) / b;  // terminal speed
      const double next = end + (v - end) * decay;
      x += end * h + (v - end) * (1.0 - decay) * m / b;
      v = next;
    }
  }
};

double law(const Wall& w, const std::vector<double>& x, std::int64_t n) {
  const auto at = [&](std::int64_t i) { return i >= 0 ? x[static_cast<std::size_t>(i)] : x.front(); };
  if (n < 0 || (!w.two_sided && at(n) <= 0.0)) return 0.0;
  const double f = -w.K_N_per_m * at(n) - w.B_N_s_per_m * (at(n) - at(n - 1)) / kT_s;
  return w.two_sided ? f : std::clamp(f, -w.peak_N, 0.0);  // a wall pushes only
}

}  // namespace

WallRun press(const Wall& w, double time_s) {
  validate::heed_stop();  // thousands of walls are pressed
  control::Passivity passivity(one_axis(w.device), kT_s, w.controller, 0.0);
  Mass mass{w.mass_kg + w.hand_mass_kg, w.damping_N_s_per_m + w.hand_N_s_per_m, w.hand_N_per_m, w.start_m};
  WallRun run;
  double port_J = 0.0, on_its_way = 0.0, v = 0.0;
  const auto ticks = static_cast<std::int64_t>(time_s / kT_s);
  for (std::int64_t n = 0; n < ticks && run.finite; ++n) {
    run.x_m.push_back(mass.x);
    double acting = 0.0;
    if (w.delay == 0) {
      acting = law(w, run.x_m, n);
    } else {
      // The passivity controller itself takes one period of delay into account, that of the bus. So the other periods
      // of w.delay are put between the sample and the control law.
      acting = on_its_way;
      if (n > 0) v = (mass.x - run.x_m[static_cast<std::size_t>(n - 1)]) / kT_s;
      passivity.observe(n, {{mass.x, 0, 0}, {mass.x, 0, 0}});
      const control::Vec3 before(on_its_way, 0, 0), wish(law(w, run.x_m, n - w.delay + 1), 0, 0);
      const control::Vec3 sent = w.controller ? passivity.control(n, wish, {v, 0, 0}, before) : wish;
      passivity.sent(n, sent, sent);
      on_its_way = sent.x();
    }
    run.f_N.push_back(acting);
    const double from = mass.x;
    mass.move(acting + w.push_N);
    port_J -= acting * (mass.x - from);
    run.lowest_port_J = std::min(run.lowest_port_J, port_J);
    run.finite = std::abs(mass.x) < 1e3;
  }
  return run;
}

double WallRun::swing_m(double from_s) const {
  const auto first = static_cast<std::size_t>(from_s / kT_s),
             last = static_cast<std::size_t>((from_s + kWindow_s) / kT_s);
  if (!finite || last > x_m.size()) return std::numeric_limits<double>::infinity();
  const auto [low, high] = std::minmax_element(x_m.begin() + static_cast<std::ptrdiff_t>(first),
                                               x_m.begin() + static_cast<std::ptrdiff_t>(last));
  return *high - *low;
}

bool is_stable(const Wall& wall, double time_s) {
  const WallRun run = press(wall, time_s);
  if (!run.finite) return false;
  const double early = run.swing_m(0.25 * time_s), late = run.swing_m(time_s - kWindow_s);
  // A limit cycle at the force limit neither grows nor decays. So a run whose amplitude stays well above the initial
  // displacement counts as unstable, too.
  const double begun = std::max(wall.start_m, wall.push_N / std::max(wall.K_N_per_m, 1.0));
  return late < 1e-6 || (late < 0.98 * early && late < 2.2 * begun);
}

double largest_stable_K(Wall wall, double tolerance) {
  wall.two_sided = true;
  wall.start_m = 1e-3;
  double low = 1.0, high = 1e6;
  while (high / low > 1.0 + tolerance) {
    wall.K_N_per_m = std::sqrt(low * high);
    (is_stable(wall, 12.0) ? low : high) = wall.K_N_per_m;
  }
  return std::sqrt(low * high);
}

}  // namespace ligature::lab
