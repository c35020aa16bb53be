#include <cstdio>

#include "host/lab/experiments/experiment.hpp"
#include "host/lab/rehearsal.hpp"
#include "host/lab/rig/haptics/hands.hpp"
#include "host/lab/rig/haptics/haptics.hpp"

namespace ligature::lab {

int experiment_haptics(const Bench& bench) {
  const auto taut_m = [&](const std::vector<std::string>& overrides) {
    return apart_when_felt_m(load_scene_or_refuse((bench.scenes / "suture-3-0-knot.toml").string(), overrides),
                             kTaut_N);
  };
  const HapticsBench b{bench.scenes, bench.out, bench.quick, taut_m({kWeightless}), taut_m({kWeightless, kPeg}),
                       bench.seed};
  Verdict v("haptics");
  std::printf(
      "haptics: walls, velocity, ports, fidelity; the firmware's own control code, simulated devices and hands\n");
  measure_z_width(b, v);
  measure_velocity(b, v);
  measure_ports(b, v);
  measure_fidelity(b, v);
  if (!bench.quick) {
    draw("haptics_zwidth.py", {b.out / "haptics-zwidth.csv", b.out / "haptics-wall-reference.csv"},
         b.out / "haptics-zwidth.png");
    draw("haptics_ports.py", {b.out / "haptics-ports.csv", b.out / "haptics-ports-table.csv"},
         b.out / "haptics-ports.png");
  }
  return v.conclude(bench.out);
}

}  // namespace ligature::lab
