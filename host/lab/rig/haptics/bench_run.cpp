#include "host/lab/rig/haptics/bench_run.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "host/lab/rig/port_bound.hpp"

namespace ligature::lab {
namespace {

constexpr double kT_s = 1e-3, kCorner_Hz = 30.0;

sim::Mat3 tip_N_per_Nm(const sim::Mechanics& m) {
  return m.plant().parameters().linkage.jacobian_D(m.plant().q_rad()).transpose().inverse();
}

}  // namespace

Watched watch(VirtualRig& rig, std::int64_t ticks, std::size_t look_at) {
  Watched w;
  // both hands have equal encoders
  const double count_rad = 2.0 * std::numbers::pi / rig.setup.body[0].drives.counts_per_revolution;
  std::array<sim::Vec3, 2> made_Nm{sim::Vec3::Zero(), sim::Vec3::Zero()};
  std::array<PortBound, 2> bounds{PortBound(rig.setup.device, 0), PortBound(rig.setup.device, 1)};
  std::array<sim::Mat3, 2> pose{sim::Mat3::Zero(), sim::Mat3::Zero()};  // torque-to-tip-force matrix at the SYNC before
  rig.each_tick = [&] {
    std::array<sim::Vec3, 2> force;
    std::array<double, 2> size{}, port{}, step{};
    const std::array<const DeviceBus*, 2> hands{&rig.left, &rig.right};
    for (std::size_t h = 0; h < 2; ++h) {
      const auto& m = hands[h]->device.mechanics();
      step[h] = (pose[h] * (m.made_Nm() - made_Nm[h])).norm();
      w.hidden_J[h] += count_rad * (m.made_Nm() - made_Nm[h]).cwiseAbs().sum();
      made_Nm[h] = m.made_Nm();
      pose[h] = tip_N_per_Nm(m);
      force[h] = pose[h] * made_Nm[h];
      size[h] = force[h].norm();
      port[h] = -hands[h]->device.mechanics().motor_work_J();
      w.lowest_port_J[h] = std::min(w.lowest_port_J[h], port[h]);
      const double bound_J = port[h] + rig.controller.hand(h).received_J;
      w.lowest_bound_J[h] = std::min(w.lowest_bound_J[h], bound_J);
      w.lowest_proved_J = std::min(w.lowest_proved_J, bound_J + w.hidden_J[h]);
      if (!rig.records.empty()) bounds[h].look(hands[h]->device, rig.records.back(), rig.controller.hand(h).received_J);
    }
    w.lowest_sum_J = std::min(w.lowest_sum_J, port[0] + port[1]);
    w.rendered_N.push_back(force);
    w.tip_force_N.push_back(size);
    w.step_N.push_back(step);
    w.port_J.push_back(port);
    if (w.port_J.size() != look_at) return;
    w.nodes_W.assign(rig.thread.nodes_W().begin(), rig.thread.nodes_W().end());
    w.tension_N.resize(w.nodes_W.size());
    std::vector<float> turn_rad(w.nodes_W.size());
    rig.thread.describe(w.tension_N, turn_rad);
  };
  if (const auto why = rig.run(ticks)) throw std::runtime_error("the rig did not start: " + *why);
  rig.each_tick = nullptr;
  w.least_margin_J = std::min(bounds[0].least_margin_J(), bounds[1].least_margin_J());
  for (const auto& r : rig.records) {
    for (std::size_t h = 0; h < 2; ++h) {
      const auto& f = r.f_device_N[h];
      w.peak_N = std::max(w.peak_N, std::hypot(f[0], f[1], f[2]));
      w.lowest_account_J[h] = std::min(w.lowest_account_J[h], r.port_energy_J[h]);
    }
    if (w.fault == 0) w.fault = r.fault;
  }
  w.sort_steps(rig.records);
  return w;
}

/// The motors make a torque two ticks after it was sent, and later when its RPDOs are lost. So force steps up to kLate
/// ticks after a fault, or after a hand was let go, count as its consequence.
void Watched::sort_steps(const std::vector<rt::TickRecord>& records) {
  constexpr std::size_t kLate = 10;
  for (std::size_t h = 0; h < 2; ++h) {
    std::size_t forgiven = 0;
    for (std::size_t i = 1; i < std::min(step_N.size(), records.size()); ++i) {
      const auto& r = records[i];
      const bool none = r.f_device_N[h] == rt::Triple{} && records[i - 1].f_device_N[h] != rt::Triple{};
      const bool gone = none && r.fault == 0 && (r.limits[h] & rt::kPassivityLimit) != 0;
      if (r.fault != 0 || gone) forgiven = i + kLate;
      const bool excess = step_N[i][h] > device::omni().force_step_N;
      let_go += excess && i <= forgiven && r.fault == 0;
      double& largest = excess && i <= forgiven ? largest_cut_N : largest_step_N;
      largest = std::max(largest, step_N[i][h]);
    }
  }
}

double Watched::chatter_N(std::size_t hand, std::size_t first, std::size_t last) const {
  const double a = 1.0 / (1.0 + 2.0 * std::numbers::pi * kCorner_Hz * kT_s);
  std::array<sim::Vec3, 2> out{sim::Vec3::Zero(), sim::Vec3::Zero()}, in{};
  last = std::min(last, rendered_N.size());
  double sum = 0.0;
  long count = 0;
  for (std::size_t i = first; i < last; ++i) {
    sim::Vec3 x = rendered_N[i][hand];
    for (std::size_t s = 0; s < 2; ++s) {
      if (i == first) in[s] = x;
      out[s] = i == first ? sim::Vec3(sim::Vec3::Zero()) : sim::Vec3(a * (out[s] + x - in[s]));
      in[s] = x;
      x = out[s];
    }
    if (i < first + 100) continue;  // skips the filter's transient
    sum += x.squaredNorm();
    ++count;
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0.0;
}

sim::Vec3 Watched::mean_N(std::size_t hand, std::size_t first, std::size_t last) const {
  sim::Vec3 sum = sim::Vec3::Zero();
  last = std::min(last, rendered_N.size());
  for (std::size_t i = first; i < last; ++i) sum += rendered_N[i][hand];
  return sum / static_cast<double>(std::max<std::size_t>(1, last - first));
}

double Watched::unrest_N(std::size_t first, std::size_t last) const {
  double worst = 0.0;
  last = std::min(last, rendered_N.size());
  for (std::size_t h = 0; h < 2 && last > first; ++h) {
    const sim::Vec3 mean = mean_N(h, first, last);
    double sum = 0.0;
    for (std::size_t i = first; i < last; ++i) sum += (rendered_N[i][h] - mean).squaredNorm();
    worst = std::max(worst, std::sqrt(sum / static_cast<double>(last - first)));
  }
  return worst;
}

double Watched::worst_chatter_N() const {
  return std::max(chatter_N(0, 500, rendered_N.size()), chatter_N(1, 500, rendered_N.size()));
}

}  // namespace ligature::lab
