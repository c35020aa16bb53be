#include "tests/bench/rod/pull.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "host/lab/cpu_time.hpp"
#include "tests/bench/rod/chatter.hpp"

namespace ligature::bench {

Puller::Puller(const scene::Scene& scene, physics::rod::RodSimulation sim, const PullOptions& options)
    : scene_(scene), sim_(std::move(sim)), options_(options) {
  tools_[0].p_WT = sim_.nodes_W().front();
  tools_[1].p_WT = sim_.nodes_W().back();
  tools_[0].grip = tools_[1].grip = true;
  if (options.work_k > 0.0) sim_.rod().numerics().work = static_cast<long>(1000.0 * options.work_k);
}

PullResult Puller::run(const Pull& pull) {
  PullResult r;
  tremble_m_ = pull.tremble_m;
  save("start");
  r.begun = knot::recognise(points(), false);
  phase(0.1, 0.0, pull.hands, 0.0);
  forces_.clear();
  static_cast<void>(lost());
  phase(5.0, pull.speed_m_per_s, pull.hands, pull.force_N);
  r.sliding = chatter(forces_, 0.05 * pull.force_N).share();
  r.pull_d = std::exchange(penetration_, 0.0);
  r.pull_lost = lost();
  phase(0.3, 0.0, pull.hands, 0.0);
  penetration_ = 0.0;
  forces_.clear();
  rise_J_ = 0.0;
  const double lost_before = lost_;
  const std::size_t ticks_before = ticks_.size();
  phase(options_.hold_s, 0.0, pull.hands, 0.0);
  r.held_J = rise_J_;
  r.held_lost = (lost_ - lost_before) / std::max(1.0, static_cast<double>(ticks_.size() - ticks_before));
  save("held");
  r.hold_d = std::exchange(penetration_, 0.0);
  r.hold_lost = lost();
  r.strain = sim_.diagnostics().max_stretch;
  r.tension_N = force();
  std::tie(r.turn_rad, r.segment_d) = sharpness();
  r.chatter = chatter(forces_, 0.0).share();
  if (!pull.sudden) phase(10.0, -0.02, 2, -0.02 * pull.force_N);
  tools_[1].grip = false;
  constexpr double kOpens_s = 0.002;  // a hold that ends takes its spring's energy along
  phase(kOpens_s, 0.0, pull.hands, 0.0);
  rise_J_ = 0.0;
  phase(options_.wait_s - kOpens_s, 0.0, pull.hands, 0.0);
  r.after_J = rise_J_;
  save("end");
  r.after_d = penetration_;
  r.after_lost = lost();
  r.left = knot::recognise(points(), false);
  r.guard = guard_;
  r.ticks = std::move(ticks_);
  return r;
}

double Puller::lost() {
  const auto ticks = static_cast<double>(ticks_.size() - std::exchange(lost_from_, ticks_.size()));
  return std::exchange(lost_, 0.0) / std::max(1.0, ticks);
}

double Puller::force() const {
  return 0.5 * (sim_.hand(physics::Hand::kLeft).f_W.x() - sim_.hand(physics::Hand::kRight).f_W.x());
}

std::vector<std::array<double, 3>> Puller::points() const {
  std::vector<std::array<double, 3>> all;
  for (const auto& p : sim_.nodes_W()) all.push_back({p.x(), p.y(), p.z()});
  return all;
}

void Puller::save(const std::string& name) const {
  if (options_.shapes.empty()) return;
  std::ofstream out(options_.shapes + "/" + name + ".csv");
  out << "x,y,z\n";
  for (const auto& p : points()) out << p[0] << ',' << p[1] << ',' << p[2] << '\n';
}

void Puller::phase(double seconds, double speed, int hands, double until_N) {
  for (int k = 0; k < static_cast<int>(std::lround(1000.0 * seconds)); ++k) {
    if (until_N > 0.0 && force() >= until_N) return;
    if (until_N < 0.0 && force() <= -until_N) return;
    for (std::size_t h = 0; h < 2; ++h) {
      const double v = h == 1 ? speed : hands == 2 ? -speed : 0.0;
      tools_[h].v_WT.x() = v;
      tools_[h].p_WT.x() += 1e-3 * v;
      constexpr double kPerTick = 2.0 * std::numbers::pi * 9e-3;
      const auto at = static_cast<double>(ticks_.size()) + 40.0 * static_cast<double>(h);
      const double y = tremble_m_ * std::sin(kPerTick * at), before = tremble_m_ * std::sin(kPerTick * (at - 1.0));
      tools_[h].p_WT.y() += y - before;
      tools_[h].v_WT.y() = 1e3 * (y - before);
    }
    const double before_J = energy_J();
    tick();
    rise_J_ = std::max(rise_J_, energy_J() - before_J);
    guard_ += sim_.rod().report().guard_events;
    penetration_ = std::max(penetration_, -sim_.diagnostics().min_gap_m / (2.0 * scene_.suture.radius_m));
    forces_.push_back(force());
  }
}

void Puller::tick() {
  const Disturbances before = options_.disturbances ? Disturbances::now() : Disturbances{};
  const double begun_us = lab::thread_cpu_us();
  sim_.tick(tools_);
  Tick t;
  t.us = lab::thread_cpu_us() - begun_us;
  if (options_.disturbances) t.met = Disturbances::now().since(before);
  t.work = sim_.rod().report().work;
  lost_ += sim_.rod().report().time_lost;
  const physics::Vec3 hands[] = {sim_.hand(physics::Hand::kLeft).f_W, sim_.hand(physics::Hand::kRight).f_W};
  t.print = fingerprint(hands, fingerprint(sim_.nodes_W(), 0xcbf29ce484222325U));
  ticks_.push_back(t);
}

std::pair<double, double> Puller::sharpness() const {
  double turn = 0.0, longest = 0.0;
  const auto& state = sim_.rod().state();
  for (const auto& c : sim_.rod().contact_set().contacts()) {
    if (!c.is_pair() || dot(c.p, c.p) == 0.0) continue;
    for (const int k : {0, 2}) {
      const auto i = static_cast<std::size_t>(c.node[k]);
      if (i < 1 || i + 1 >= state.x.size()) continue;
      const auto a = state.x[i] - state.x[i - 1], b = state.x[i + 1] - state.x[i];
      turn = std::max(turn, std::atan2(norm(cross(a, b)), dot(a, b)));
      longest = std::max(longest, state.mesh.rest[i] / (2.0 * scene_.suture.radius_m));
    }
  }
  return {turn, longest};
}

}  // namespace ligature::bench
