// Energy at both device ports for many kinds of hand motion, with and without the passivity controller.

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "host/lab/rig/haptics/port_cases.hpp"
#include "host/lab/rig/haptics/wall.hpp"
#include "host/lab/run_files.hpp"

namespace ligature::lab {
namespace {

double least(const std::array<double, 2>& of) { return std::min(of[0], of[1]); }

/// Extreme values over all runs with the passivity controller.
struct Worst {
  // without lost frames
  double account_J = 0.0, bound_J = 0.0, proved_J = 0.0, sum_J = 0.0, alone_J = 0.0;
  double margin_J = 1e9, step_N = 0.0;
  int runs = 0, lossy_runs = 0, let_go = 0, let_go_wild = 0;

  void add(const PortCase& c, const Watched& w) {
    const bool lossy = c.frame_loss > 0.0;
    ++(lossy ? lossy_runs : runs);
    margin_J = std::min(margin_J, w.least_margin_J);
    step_N = std::max(step_N, w.largest_step_N);
    (c.wild || lossy ? let_go_wild : let_go) += w.let_go;
    if (lossy) return;  // the floor of -1 uJ is then no theorem
    account_J = std::min(account_J, least(w.lowest_account_J));
    bound_J = std::min(bound_J, least(w.lowest_bound_J));
    proved_J = std::min(proved_J, w.lowest_proved_J);
    sum_J = std::min(sum_J, w.lowest_sum_J);
    if (!c.gives_way) alone_J = std::min(alone_J, least(w.lowest_port_J));
  }
};

/// Writes the table and the traces of all runs.
class PortFiles {
 public:
  explicit PortFiles(const HapticsBench& bench)
      : out_(bench.out),
        traces_(bench.out / "haptics-ports.csv", "run,controller,t_s,left_N,right_N,left_uJ,right_uJ") {}

  void add(int number, const PortCase& c, bool controller, const Watched& w) {
    table_.row({c.name, std::string(controller ? "on" : "off"), 1e6 * w.lowest_port_J[0], 1e6 * w.lowest_port_J[1],
                1e6 * least(w.lowest_bound_J), 1e6 * w.lowest_sum_J, 1e6 * least(w.lowest_account_J), w.peak_N,
                w.largest_step_N, w.largest_cut_N, double(w.let_go), 1e3 * w.worst_chatter_N(), double(w.fault)});
    for (std::size_t i = 0; i < w.tip_force_N.size(); i += 4)
      traces_.row(std::array{double(number), double(controller), 1e-3 * static_cast<double>(i), w.tip_force_N[i][0],
                             w.tip_force_N[i][1], 1e6 * w.port_J[i][0], 1e6 * w.port_J[i][1]});
    std::printf("  %-36s %-3s ports %9.2f %9.2f uJ, peak %.2f N, step %.2f N, above 30 Hz %6.1f mN, fault %d\n",
                c.name.c_str(), controller ? "on" : "off", 1e6 * w.lowest_port_J[0], 1e6 * w.lowest_port_J[1], w.peak_N,
                w.largest_step_N, 1e3 * w.worst_chatter_N(), w.fault);
  }
  void close() {
    traces_.close();
    table_.write(out_ / "haptics-ports-table.csv");
  }

 private:
  std::filesystem::path out_;
  CsvFile traces_;
  Table table_{{"run", "controller", "left_uJ", "right_uJ", "port_and_received_uJ", "sum_uJ", "account_uJ", "peak_N",
                "step_N", "cut_N", "let_go", "above_30Hz_mN", "fault"}};
};

/// A hand that is dragged must receive energy through its port. Without energy lent by the other hand's account it
/// would feel less than half of the force.
void measure_giving_way(const HapticsBench& bench, Verdict& v) {
  for (const PortCase& c : port_cases(bench)) {
    if (!c.gives_way) continue;
    PortCase alone = c;
    alone.trouble = [](RigSetup& setup) { setup.settings.lending = false; };
    const Watched together = play(bench, c, true), apart = play(bench, alone, true);
    const std::size_t from = 3800, to = 4100;  // ticks in which the hand is dragged and comes to rest
    const auto share = [&](const Watched& w) { return w.mean_N(1, from, to).norm() / w.mean_N(0, from, to).norm(); };
    v.claim(together.lowest_port_J[1] < -1e-3, "Ports: the hand that gives way gets energy of the one that pulls, J",
            digits(together.lowest_port_J[1]), "below -1e-3");
    v.claim(share(together) > 0.95 && share(apart) < 0.5,
            "Ports: what it feels of the other's force, and when each port is bounded alone",
            digits(share(together)) + ", " + digits(share(apart)), "above 0.95, below 0.5");
  }
}

/// Knot pulled tight and held below all limits, with 5 % of the frames lost: the force must be kept.
void measure_lossy_feel(const HapticsBench& bench, Verdict& v) {
  constexpr std::size_t kFrom = 4800, kTo = 6800;
  PortCase pull;
  pull.script = pull_and_release(bench.taut_m, 2.0, 4.0);
  const Watched whole = play(bench, pull, true);
  pull.frame_loss = 0.05;
  double least_share = 1.0, least_J = 0.0, margin_J = 1e9;
  const int seeds = bench.quick ? 2 : 10;
  for (int k = 0; k < seeds; ++k) {
    pull.trouble = [&](RigSetup& setup) { setup.seed = bench.seed + static_cast<std::uint64_t>(k); };
    const Watched w = play(bench, pull, true);
    margin_J = std::min(margin_J, w.least_margin_J);
    for (std::size_t h = 0; h < 2; ++h) {
      const double enough_N = 0.8 * whole.mean_N(h, kFrom, kTo).norm();
      long felt = 0;
      for (std::size_t i = kFrom; i < kTo; ++i) felt += w.tip_force_N[i][h] >= enough_N;
      least_share = std::min(least_share, static_cast<double>(felt) / (kTo - kFrom));
      least_J = std::min(least_J, w.lowest_port_J[h]);
    }
  }
  v.claim(least_share >= 0.9 && margin_J >= 0.0,
          "Ports: time in which a pull held with 5 % of the frames lost is felt by 4/5, least energy in J, and least "
          "margin to the bounds of docs/passivity.md, J",
          digits(least_share) + " of it, " + digits(least_J) + ", " + digits(margin_J) + ", " + std::to_string(seeds) +
              " seeds",
          "0.9 or more, any, 0 or more");
}

/// A wall ten times too stiff, pushed with 0.5 N while no hand holds the device: the simplest case that is unstable
/// without the controller.
void measure_instability(Verdict& v) {
  Wall wall;
  wall.K_N_per_m = 2000.0;
  wall.push_N = 0.5;
  std::array<double, 2> least_J{}, unrest_N{};
  for (const bool controller : {false, true}) {
    wall.controller = controller;
    const WallRun run = press(wall, 4.0);
    double mean = 0.0, square = 0.0;
    for (std::size_t i = 3000; i < 4000; ++i) mean += run.f_N[i] / 1000.0;
    for (std::size_t i = 3000; i < 4000; ++i) square += std::pow(run.f_N[i] - mean, 2) / 1000.0;
    least_J[controller] = run.lowest_port_J;
    unrest_N[controller] = std::sqrt(square);
  }
  v.claim(least_J[0] < -0.05 && least_J[1] >= -1e-6, "Ports: wall of 2 kN/m, least energy without and with it, J",
          digits(least_J[0]) + ", " + digits(least_J[1]), "below -0.05, -1e-6 or more");
  v.claim(unrest_N[0] > 0.5 && unrest_N[1] < 0.01, "Ports: its force after 3 s, rms about the mean, N",
          digits(unrest_N[0]) + ", " + digits(unrest_N[1]), "above 0.5, below 0.01");
}

}  // namespace

void measure_ports(const HapticsBench& bench, Verdict& v) {
  PortFiles files(bench);
  Worst worst;
  double wild_J = 0.0, tame_J = 0.0;
  int number = 0;
  for (const PortCase& c : port_cases(bench)) {
    ++number;
    if (bench.quick && !c.in_quick) continue;
    for (const bool controller : {false, true}) {
      if (bench.quick && !controller) continue;
      const Watched w = play(bench, c, controller);
      files.add(number, c, controller, w);
      if (controller) worst.add(c, w);
      if (c.unstable_without) (controller ? tame_J : wild_J) = least(w.lowest_port_J);
    }
  }
  files.close();
  const std::string runs = std::to_string(worst.runs) + " runs with the controller, no frames lost, J";
  v.claim(worst.account_J >= -1e-6, "Ports: least account of " + runs, digits(worst.account_J), "-1e-6 or more");
  v.claim(worst.alone_J >= -1e-6, "Ports: least true energy of a port that nobody pulls, J", digits(worst.alone_J),
          "-1e-6 or more");
  v.claim(worst.proved_J >= -1e-6 && worst.bound_J >= -0.5e-3,
          "Ports: least true energy of any port and what the other gave it; and what its counts could hide, J",
          digits(worst.bound_J) + ", " + digits(worst.proved_J), "-0.5e-3, -1e-6 or more");
  v.claim(worst.margin_J >= 0.0,
          "Ports: least margin to the bounds of docs/passivity.md, also in " + std::to_string(worst.lossy_runs) +
              " runs with lost frames, J",
          digits(worst.margin_J), "0 or more");
  v.claim(worst.sum_J >= -1e-6, "Ports: least true energy of both ports together, J", digits(worst.sum_J),
          "-1e-6 or more");
  v.claim(worst.step_N <= device::omni().force_step_N,
          "Ports: largest step of what the motors make, but where a fault or a wild hand takes all, N",
          digits(worst.step_N), "up to " + digits(device::omni().force_step_N));
  v.claim(worst.let_go == 0,
          "Ports: hands let go at once for want of energy; and where frames are lost or hands fight back",
          std::to_string(worst.let_go) + ", " + std::to_string(worst.let_go_wild), "none, any");
  if (!bench.quick)
    v.claim(wild_J < -0.05 && tame_J >= -1e-6,
            "Ports: a short taut thread, too stiff, without the controller and with, J",
            digits(wild_J) + ", " + digits(tame_J), "below -0.05, -1e-6 or more");
  measure_lossy_feel(bench, v);
  measure_instability(v);
  measure_giving_way(bench, v);
}

}  // namespace ligature::lab
