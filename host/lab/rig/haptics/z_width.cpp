// Which walls can be rendered (Z-width), with and without the passivity controller, and comparison with theory.

#include <algorithm>
#include <cmath>

#include "host/lab/rig/haptics/haptics.hpp"
#include "host/lab/rig/haptics/wall.hpp"
#include "host/lab/run_files.hpp"
#include "host/lab/validate/reference.hpp"
#include "protocol/device/device_file.hpp"
#include "sim_device/hand.hpp"

namespace ligature::lab {
namespace {

constexpr double kT_s = 1e-3, kPush_N = 0.5;

/// Compares the simulated stability limit, found by bisection, with every case of the reference table.
void against_reference(const HapticsBench& bench, Verdict& v) {
  CsvFile file(bench.out / "haptics-wall-reference.csv",
               "m_kg,b_Ns_m,B_Ns_m,delay_samples,reference_K_N_m,simulated_K_N_m,deviation");
  const auto rows = validate::reference_rows("09_virtual_wall_uncoupled_stability.csv");
  double worst = 0.0;
  int cases = 0;
  for (std::size_t i = 0; i < rows.size(); i += bench.quick ? 7 : 1, ++cases) {
    const auto cell = [&](const char* name) { return validate::number(rows[i], name); };
    Wall wall;
    wall.mass_kg = cell("m_kg");
    wall.damping_N_s_per_m = cell("b_Ns_m");
    wall.B_N_s_per_m = cell("B_Ns_m");
    wall.delay = static_cast<int>(cell("delay_samples"));
    const double found = largest_stable_K(wall), truth = cell("max_stable_K_N_m");
    worst = std::max(worst, std::abs(found / truth - 1.0));
    file.row(std::array{wall.mass_kg, wall.damping_N_s_per_m, wall.B_N_s_per_m, double(wall.delay), truth, found,
                        found / truth - 1.0});
  }
  file.close();
  v.claim(worst <= 0.10 && cases > 0, "Z-width: largest K of " + std::to_string(cases) + " reference cases, deviation",
          digits(worst), "up to 0.1");
}

struct Count {
  int points = 0, stable = 0;
  [[nodiscard]] std::string text() const { return std::to_string(stable) + " of " + std::to_string(points); }
};

/// Map of stable walls: a constant push of 0.5 N against each wall, starting at its surface.
void sweep(const HapticsBench& bench, const device::Device& device, const char* name, Verdict& v) {
  CsvFile file(bench.out / name,
               "delay_samples,controller,B_N_s_per_m,K_N_per_m,stable,swing_mm,depth_mm,lowest_port_J");
  const int n_K = bench.quick ? 9 : 31, n_B = bench.quick ? 4 : 13;
  Count held, free_below;
  double lowest_J = 0.0;
  for (const bool controller : {false, true}) {
    for (int delay = controller ? 1 : 0; delay <= 3; ++delay) {
      for (int i = 0; i < n_K * n_B; ++i) {
        Wall wall = Wall::of(device);
        wall.K_N_per_m = 20.0 * std::pow(500.0, static_cast<double>(i % n_K) / (n_K - 1));
        const int row = i / n_K;
        wall.B_N_s_per_m = 1.5 * row / (n_B - 1);
        wall.delay = delay;
        wall.controller = controller;
        wall.push_N = kPush_N;
        const WallRun run = press(wall, 4.0);
        const bool stable = is_stable(wall, 4.0);
        const double depth_mm = run.finite ? 1e3 * run.x_m.back() : 0.0;
        file.row(std::array{double(delay), double(controller), wall.B_N_s_per_m, wall.K_N_per_m, double(stable),
                            1e3 * std::min(1.0, run.swing_m(3.5)), depth_mm, run.lowest_port_J});
        if (controller) {
          ++held.points;
          held.stable += stable;
          lowest_J = std::min(lowest_J, run.lowest_port_J);
        }
        const bool passive = device.damping_N_s_per_m > wall.K_N_per_m * kT_s / 2 + wall.B_N_s_per_m;
        if (!controller && delay == 0 && passive) {
          ++free_below.points;
          free_below.stable += stable;
        }
      }
    }
  }
  file.close();
  v.claim(free_below.stable == free_below.points && free_below.points > 0,
          "Z-width, " + device.name + ": stable without controller below the line b = KT/2 + |B|", free_below.text(),
          "all");
  v.claim(held.stable == held.points,
          "Z-width, " + device.name + ": stable with the controller, K to 10 kN/m, B to 1.5, delay 1 .. 3", held.text(),
          "all");
  v.claim(lowest_J >= -1e-6, "Z-width, " + device.name + ": least port energy with the controller, J", digits(lowest_J),
          "-1e-6 or more");
}

/// Influence of the hand: the largest stable stiffness for each grip and delay.
void hands(const HapticsBench& bench, Verdict& v) {
  Table table({"hand", "mass_g", "stiffness_N_per_m", "damping_N_s_per_m", "K_max_0", "K_max_1", "K_max_2", "K_max_3"});
  struct Kind {
    const char* name;
    sim::Hand hand;
    device::Device device = device::omni();
  };
  double bare = 0.0, clenched = 0.0;
  const auto second = std::get<device::Device>(device::load_device(bench.scenes / "devices/cartesian.toml"));
  for (const auto& [name, hand, device] :
       {Kind{"none", sim::Hand::absent()}, Kind{"none, cartesian", sim::Hand::absent(), second},
        Kind{"loose", sim::Hand::holding(0.0)}, Kind{"firm", sim::Hand::holding(0.5)},
        Kind{"clenched", sim::Hand::holding(1.0)}, Kind{"light", sim::Hand{}}}) {
    std::vector<Cell> row{std::string(name), 1e3 * hand.mass_kg, hand.stiffness_N_per_m, hand.damping_N_s_per_m};
    for (int delay = 0; delay <= 3; ++delay) {
      Wall wall = Wall::of(device);
      wall.delay = delay;
      wall.hand_mass_kg = hand.mass_kg;
      wall.hand_N_per_m = hand.stiffness_N_per_m;
      wall.hand_N_s_per_m = hand.damping_N_s_per_m;
      const double K = largest_stable_K(wall, bench.quick ? 0.1 : 0.01);
      row.emplace_back(K);
      if (delay == 1 && std::string(name) == "none") bare = K;
      if (delay == 1 && std::string(name) == "clenched") clenched = K;
    }
    table.row(row);
  }
  table.print();
  table.write(bench.out / "haptics-hands.csv");
  v.claim(bare > 0.0 && clenched > bare, "Hands: largest K at one sample, bare and clenched, N/m",
          digits(bare) + ", " + digits(clenched), "a hand helps");
}

}  // namespace

void measure_z_width(const HapticsBench& bench, Verdict& v) {
  against_reference(bench, v);
  sweep(bench, device::omni(), "haptics-zwidth.csv", v);
  const auto second = device::load_device(bench.scenes / "devices/cartesian.toml");
  sweep(bench, std::get<device::Device>(second), "haptics-zwidth-cartesian.csv", v);
  hands(bench, v);
}

}  // namespace ligature::lab
