#include "tests/integration/virtual_rig/drive_matrix.hpp"

#include <unistd.h>

#include <cmath>
#include <stdexcept>

#include "sim_device/power_stage.hpp"

namespace ligature {
namespace {

/// The right hand holds still, the left one moves up and down.
scene::GripperScript pulls() {
  constexpr double kStill_s = 1.0, kRise_s = 0.6, kTurn_s = 0.3, kEnd_s = 9.0;
  scene::GripperScript script;
  script.keys[0] = {{0.0, {0.0, 0.0, 2.3}, true}, {kStill_s, {0.0, 0.0, 2.3}, true}};
  bool up = true;
  for (double t_s = kStill_s + kRise_s; t_s < kEnd_s; t_s += kTurn_s, up = !up)
    script.keys[0].push_back({t_s, {0.0, 0.0, up ? 5.0 : 3.8}, true});
  script.keys[1] = {{0.0, {0.0, 0.0, 0.5}, true}, {kEnd_s, {0.0, 0.0, 0.5}, true}};
  return script;
}

}  // namespace

MatrixRig::MatrixRig(const std::string& record, const device::Device& device, int watchdog_ms)
    : ShelfRig(record, device, pulls()), watchdog_ms_(watchdog_ms) {}

std::vector<std::optional<Outcome>> MatrixRig::run(const std::vector<Trial>& trials, std::int64_t ticks,
                                                   int watched_ticks) {
  watched_ticks_ = watched_ticks;
  std::vector<std::optional<Outcome>> outcomes(trials.size());
  each_tick = [&] {
    if (copy_.is_copy()) return watch();
    for (std::size_t i = 0; i < trials.size(); ++i) {
      if (outcomes[i] || cycle.periods() < trials[i].from || !acts(trials[i])) continue;
      outcomes[i] = copy_.branch();
      if (copy_.is_copy()) return begin(trials[i]);
    }
  };
  const auto why = VirtualRig::run(ticks);
  if (copy_.is_copy()) _exit(1);  // it should have told its outcome before
  if (why) throw std::runtime_error(*why);
  return outcomes;
}

/// Whether torque acts that can be felt, not only at a drive that fails: that one loses its torque by itself.
bool MatrixRig::acts(const Trial& trial) const {
  const Torques now_Nm = torques_Nm();
  const double felt_Nm = 0.1 * setup.device.rated_torque_Nm;
  for (std::size_t h = 0; h < 2; ++h) {
    for (std::size_t j = 0; j < 3; ++j) {
      const bool is_meant = trial.ends == Ends::kFault ? h != trial.hand || j != trial.drive : h == trial.hand;
      if (is_meant && std::abs(now_Nm[h][j]) >= felt_Nm) return true;
    }
  }
  return false;
}

void MatrixRig::begin(const Trial& trial) {
  trial_ = trial;
  at_first_Nm_ = torques_Nm();
  speeds_before_ = speeds();
  trips_before_ = trips();
  outcome_.was_in_force = controller.state() == control::State::kForce;
  DeviceBus& side = *buses()[trial.hand];
  if (trial.ends == Ends::kSilence) left.cut = right.cut = true;
  if (trial.ends == Ends::kRelease) lets_go[trial.hand] = true;
  if (trial.ends != Ends::kFault) return;
  if (setup.device.odrive || setup.device.moteus) return sim::fail_power_stage(*side.device.drives()[trial.drive]);
  side.faults.emplace(scene::FaultScript{.title = {},  // it tells the fault, and makes torque until it is stopped
                                         .kind = scene::FaultKind::kEmergency,
                                         .node = static_cast<int>(trial.drive) + 1});
}

void MatrixRig::watch() {
  ++tick_;
  const bool has = trial_.ends == Ends::kRelease ? has_torque(*buses()[trial_.hand]) : has_torque();
  if (has) outcome_.last = tick_;
  if (has_commanded_torque()) outcome_.last_commanded = tick_;
  outcome_.stays = outcome_.stays && torques_Nm() == at_first_Nm_;
  if (tick_ > watchdog_ms_ + 2) look_for_pushes();
  speeds_before_ = speeds();
  if (tick_ < watched_ticks_) return;
  outcome_.trips = trips() - trips_before_;
  outcome_.fault = static_cast<int>(controller.fault());
  copy_.tell(outcome_);
}

bool MatrixRig::has_commanded_torque() {
  return std::ranges::any_of(buses(), [](const DeviceBus* b) {
    return std::ranges::any_of(b->device.drives(),
                               [](const auto& d) { return d->is_enabled() && d->torque_Nm() != 0.0; });
  });
}

/// A drive that damps looks at the speed at some moment of the tick. So its torque may point along the speed at one end
/// of the tick, if the speed changed its sign meanwhile, but not along both.
void MatrixRig::look_for_pushes() {
  const Torques now_Nm = torques_Nm();
  const auto speeds_now = speeds();
  for (std::size_t h = 0; h < 2; ++h) {
    for (std::size_t j = 0; j < 3; ++j) {
      const double torque_Nm = now_Nm[h][j];
      const auto axis = static_cast<Eigen::Index>(j);
      outcome_.pushed += torque_Nm * speeds_now[h][axis] > 0.0 && torque_Nm * speeds_before_[h][axis] > 0.0;
      outcome_.most_left_Nm = std::max(outcome_.most_left_Nm, std::abs(torque_Nm));
    }
  }
}

MatrixRig::Torques MatrixRig::torques_Nm() const {
  const auto of = [](const DeviceBus& b) {
    const auto& d = b.device.drives();
    return std::array{d[0]->torque_Nm(), d[1]->torque_Nm(), d[2]->torque_Nm()};
  };
  return {of(left), of(right)};
}

std::array<sim::Vec3, 2> MatrixRig::speeds() const {
  return {left.device.mechanics().plant().omega_rad_per_s(), right.device.mechanics().plant().omega_rad_per_s()};
}

}  // namespace ligature
