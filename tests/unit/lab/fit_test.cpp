// `ligature-lab fit`: its laws compared with reference values and with the rod itself, and parameters found in noisy
// data.

#include "host/lab/fit/fit.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <numbers>

#include "host/lab/fit/shapes.hpp"
#include "host/lab/outcome.hpp"
#include "host/lab/validate/reference.hpp"
#include "host/lab/validate/specimen.hpp"
#include "tests/support/random.hpp"
#include "tests/support/share.hpp"
#include "tests/support/temp_folder.hpp"

namespace ligature::fit {
namespace {

using validate::number;
using validate::reference_rows;

TEST(FitShapes, TheSagIsTheHeavyElasticas) {
  for (const auto& row : reference_rows("01_heavy_elastica.csv"))
    EXPECT_NEAR(sag_over_length(number(row, "wL3_over_EI")), number(row, "tip_y_over_L"), 5e-6);
}

TEST(FitShapes, StiffThreadsSwingAsCantileversAndLimpOnesAsChains) {
  const double stiff = 2.0 * std::numbers::pi / swing_of({1.0, 1e4, 1.0, 0.0, 0.0}).period_s;
  EXPECT_NEAR(stiff / 100.0,
              number(reference_rows("03_bending_modes.csv").front(), "omega_times_L2_sqrt(rhoA_over_EI)"), 1e-3);
  const double limp = 2.0 * std::numbers::pi / swing_of({1.0, 1e-6, 1.0, 0.0, 0.0}).period_s;
  EXPECT_NEAR(limp / std::sqrt(kGravity_m_per_s2), 0.5 * 2.404826, 0.01);  // a chain: half the first zero of J0
}

// With viscous damping the first mode decays at the rate (c + tau omega^2) / 2, c air drag, tau bend damping, omega
// angular frequency. This thread is so stiff that its weight does not matter.
TEST(FitShapes, DecayOfAStiffThreadIsHalfOfDragAndBendDamping) {
  const double omega = 3.5160152685 * 100.0;
  const auto swing = swing_of({1.0, 1e4, 1.0, 2e-5, 3.0});
  EXPECT_NEAR(swing.decay_per_s, 0.5 * (3.0 + 2e-5 * omega * omega), 1e-3 * swing.decay_per_s);
}

/// A suture as a lab would measure it by the recipe of docs/materials.md, with the reading errors that it names.
struct Lab {
  Parameters truth{8e-5, 0.5, 71.0, 0.3, 4e-7, 0.002, 5.0};
  double noise = 1.0;  ///< 0: exact readings; 1: the recipe's
  test::Random random{1};

  double read(double value, double error) { return value + noise * error * random.normal(); }

  Measurement of(const char* name, int rows, const std::function<std::vector<double>(int)>& row) {
    for (const auto& law : laws()) {
      if (law.name != std::string(name)) continue;
      Measurement m{&law, std::string(name) + ".csv", {}};
      for (int k = 0; k < rows; ++k) m.rows.push_back(row(k));
      return m;
    }
    throw std::runtime_error(name);
  }
  std::vector<Measurement> all() {
    const double w = truth[kDensity] * kGravity_m_per_s2;
    return {of("weigh", 5,
               [&](int) {
                 return std::vector{read(1.0, 1e-3), read(truth[kDensity], 0.5e-6)};
               }),
            of("load", 8,
               [&](int k) {
                 const double load = 0.7 * k;
                 return std::vector{load, read(truth[kNatural] * (1.0 + load / truth[kEA]), 0.2e-3)};
               }),
            of("drag", 8,
               [&](int k) {
                 const double degrees = 180.0 * (1 + k % 4);
                 const double high = std::exp(truth[kFriction] * degrees * std::numbers::pi / 180.0);
                 return std::vector{degrees, read(1.0, 0.02), read(high, 0.02 * high)};
               }),
            of("sag", 10,
               [&](int k) {
                 const double length = 0.07 + 0.005 * k,
                              sag = length * sag_over_length(w * std::pow(length, 3) / truth[kEI]);
                 return std::vector{read(length, 0.3e-3), read(sag, 0.5e-3)};
               }),
            of("swing", 32, [&](int k) { return swings(k % 2 == 0); })};
  }
  std::vector<double> swings(bool shortest) {
    const double length = shortest ? 0.05 : 0.2, count = shortest ? 1.5 : 1.0, from = shortest ? 0.01 : 0.03;
    const auto swing = swing_of({length, truth[kEI], truth[kDensity], truth[kBendDamping], truth[kDrag]});
    const double time = count * swing.period_s, to = from * std::exp(-swing.decay_per_s * time);
    return {read(length, 0.3e-3), count, read(time, 2e-3), read(from, 1e-4), read(to, 1e-4)};
  }
};

TEST(Fit, OfExactReadingsIsExact) {
  Lab lab;
  lab.noise = 0.0;
  const auto fitted = fit(lab.all());
  for (std::size_t k = 0; k < kParameters; ++k)
    EXPECT_NEAR(fitted.found[k]->value / lab.truth[k], 1.0, 1e-5) << kTold[k].name;
}

// The fit starts from one suture's values and must find other threads, too.
TEST(Fit, FindsThreadsTenTimesStifferAndLimper) {
  for (const double factor : {0.1, 10.0}) {
    Lab lab;
    lab.noise = 0.0;
    lab.truth[kEA] *= factor;
    lab.truth[kEI] *= factor;
    lab.truth[kFriction] *= factor < 1.0 ? 0.2 : 1.5;
    lab.truth[kDrag] *= factor < 1.0 ? 0.2 : 2.0;
    lab.truth[kBendDamping] /= factor;
    const auto fitted = fit(lab.all());
    for (std::size_t k = 0; k < kParameters; ++k)
      EXPECT_NEAR(fitted.found[k]->value / lab.truth[k], 1.0, 1e-4) << kTold[k].name << " times " << factor;
  }
}

TEST(Fit, NoisyReadingsGiveParametersWithinThreePercent) {
  constexpr int kDraws = 24;
  std::array<int, kParameters> near{}, covered{};
  int all_covered = 0;
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
    Lab lab;
    lab.random = test::Random(9000 + seed);
    const auto fitted = fit(lab.all());
    for (std::size_t k = 0; k < kParameters; ++k) {
      const auto& e = *fitted.found[k];
      near[k] += std::abs(e.value / lab.truth[k] - 1.0) <= 0.03;
      covered[k] += std::abs(e.value - lab.truth[k]) <= e.half_95;
    }
  }
  for (std::size_t k = 0; k < kParameters; ++k) {
    std::printf("%-18s within 3 %%: %s %%; inside its 95 %% interval: %s %%\n", kTold[k].name,
                test::share(near[k], kDraws).c_str(), test::share(covered[k], kDraws).c_str());
    EXPECT_GE(near[k], kDraws * 9 / 10) << kTold[k].name;
    all_covered += covered[k];
  }
  // All parameters together: the share of a single one in 24 sets varies too much to be judged.
  EXPECT_GE(all_covered, kDraws * static_cast<int>(kParameters) * 8 / 10);
}

// The implicit time step itself damps, as if damping_s were longer by about one step: 12.5 us at accuracy "fine", which
// is 0.6 % of the damping_s of 2 ms used here.
constexpr double kTick_s = 5e-4;

/// A rod of the given length, clamped at the origin; fine time steps, no contact.
scene::Scene clamped(double length_m, physics::Vec3 along, const Parameters& truth) {
  auto scene = validate::real_thread({scene::Model::kRod, 50, scene::Accuracy::kFine}, length_m / 0.3, 0.0);
  scene.contact.solver = scene::ContactSolver::kNone;
  scene.suture.rod.density_kg_per_m = truth[kDensity];
  scene.suture.rod.damping_s = truth[kBendDamping];
  validate::set_bending(scene, truth[kEI]);
  validate::set_drag(scene, truth[kDrag]);
  scene.time.tick_s = kTick_s;
  scene.world.gravity_m_per_s2 = {0, 0, -kGravity_m_per_s2};
  scene.world.fixed.push_back({0, {0, 0, 0}, scene::Vec{along.x(), along.y(), along.z()}});
  validate::lay(scene, [&](double s) -> physics::Vec3 { return s * along; });
  return scene;
}

double sag_of_the_rod(double length_m, const Parameters& truth) {
  auto quick = truth;
  quick[kDrag] = 50.0;  // only comes to rest sooner
  auto sim = validate::build(clamped(length_m, physics::Vec3(1, 0, 0), quick));
  EXPECT_TRUE(validate::settle(sim, validate::no_hands(), 1e-5, 10000));
  return -sim.nodes_W().back().z();
}

/// A row of 'swing', read from two peaks of a swinging rod's tip, as from a film of 2000 pictures a second.
std::vector<double> swing_of_the_rod(double length_m, int swings, const Parameters& truth) {
  auto scene = clamped(length_m, physics::Vec3(0, 0, -1), truth);
  auto sim = validate::build(scene);
  std::vector<physics::Vec3> bent;  // the first mode, roughly
  for (const auto& p : sim.nodes_W()) bent.push_back(p + physics::Vec3(0.5 * p.z() * p.z() * 0.1 / length_m, 0, 0));
  sim.set_state(bent, {});
  std::vector<std::pair<double, double>> peaks;
  double before = 0.0, last = 0.0;
  for (int k = 0; k < 10000 && static_cast<int>(peaks.size()) < swings + 2; ++k) {
    validate::proceed(sim, validate::no_hands());
    const double now = sim.nodes_W().back().x();
    if (k > 1 && last > before && last >= now) peaks.emplace_back(kTick_s * k, last);
    before = last, last = now;
  }
  EXPECT_EQ(peaks.size(), static_cast<std::size_t>(swings) + 2);
  const auto& from = peaks[1];  // after one swing the higher modes have died away
  const auto& to = peaks.back();
  return {length_m, static_cast<double>(swings), to.first - from.first, from.second, to.second};
}

// Measuring the simulated thread by the recipe gives the scene's own values back.
TEST(Fit, MeasuredOnTheRodItGivesTheScenesValues) {
  Lab lab;
  lab.noise = 0.0;
  auto all = lab.all();
  all[3].rows.clear();
  for (const double length : {0.07, 0.09, 0.11}) all[3].rows.push_back({length, sag_of_the_rod(length, lab.truth)});
  all[4].rows.clear();
  for (const double length : {0.07, 0.1, 0.15, 0.2})
    all[4].rows.push_back(swing_of_the_rod(length, length < 0.1 ? 1 : 2, lab.truth));
  const auto fitted = fit(all);
  for (const auto k : {kEI, kBendDamping, kDrag}) {
    std::printf("%s: %g of %g\n", kTold[k].name, fitted.found[k]->value, lab.truth[k]);
    EXPECT_NEAR(fitted.found[k]->value / lab.truth[k], 1.0, 0.03) << kTold[k].name;
  }
}

// A thread that becomes shorter under a load has no EA: the fit runs away to a stiffness without end.
TEST(Fit, AValueThatNoSceneTakesIsLeftOut) {
  Lab lab;
  std::vector<Measurement> all{lab.of("load", 0, {})};
  all[0].rows = {{0.0, 0.5}, {1.0, 0.4}, {2.0, 0.3}};
  auto fitted = fit(all);
  const auto lines = leave_out_impossible(fitted);
  EXPECT_FALSE(fitted.found[kEA]);
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines.back().find("EA_N"), std::string::npos) << lines.back();
  EXPECT_NE(lines.back().find(", allowed "), std::string::npos) << lines.back();
}

TEST(Fit, ValuesAreHeldAgainstTheRangesOfTheScene) {
  Fitted fitted;
  fitted.found[kDensity] = Estimate{1e5, 1.0};
  fitted.found[kNatural] = Estimate{0.5, 1e-3};
  fitted.found[kEA] = Estimate{6.8e14, 1e14};
  fitted.found[kFriction] = Estimate{1001.0, 1.0};
  fitted.found[kEI] = Estimate{3.8e-46, 0.0};  // the law does not depend on it any more
  fitted.found[kBendDamping] = Estimate{std::nan(""), std::nan("")};
  fitted.found[kDrag] = Estimate{5.0, 60.0};
  const auto lines = leave_out_impossible(fitted);
  const char* const begin[] = {"key 'suture.density_kg_per_m': found 1e+05, allowed number 1e-09 .. 10000",
                               "key 'suture.EA_N': found 6.8e+14, allowed number 1e-06 .. 1e+09",
                               "key 'contact.friction': found 1001, allowed number 0 .. 1000",
                               "EI_N_m2: found 3.8e-46 +- 0, allowed a value that the rows tell",
                               "damping_s: found nan +- nan, allowed",
                               "air_drag_per_s: found 5 +- 60, allowed"};
  ASSERT_EQ(lines.size(), std::size(begin));
  for (std::size_t k = 0; k < lines.size(); ++k) EXPECT_TRUE(lines[k].starts_with(begin[k])) << lines[k];
  for (std::size_t k = 0; k < kParameters; ++k) EXPECT_EQ(fitted.found[k].has_value(), k == kNatural) << kTold[k].name;
}

TEST(Fit, OfALabsReadingsNothingIsLeftOut) {
  Lab lab;
  auto fitted = fit(lab.all());
  EXPECT_TRUE(leave_out_impossible(fitted).empty());
}

std::string refusal_of(const std::vector<std::string>& texts) {
  std::vector<Measurement> all;
  try {
    for (const auto& text : texts) {
      const auto path = std::filesystem::path(test::temp_folder() + "m.csv");
      std::ofstream(path) << text;
      all.push_back(read_measurement(path));
    }
    check_enough(all);
  } catch (const lab::Refusal& refusal) {
    EXPECT_EQ(refusal.code, lab::kBadInput);
    return refusal.what();
  }
  return "accepted";
}

TEST(FitFile, BadOnesAreRefusedInOneLine) {
  const std::string weigh = "length_m,mass_kg\n1,8e-5\n1,8e-5\n1,8e-5\n";
  const std::pair<std::vector<std::string>, const char*> cases[] = {
      {{"tea,milk\n1,2\n"}, "m.csv:1: found 'tea,milk', allowed one of the headers 'length_m,mass_kg'"},
      {{"# nothing\n"}, "m.csv: found no line, allowed one of the headers"},
      {{"length_m,mass_kg\n1,-8e-5\n"}, "m.csv:2: column 'mass_kg': found '-8e-5', allowed 1e-09 .. 1e+04"},
      {{"length_m,mass_kg\n1,nan\n"}, "m.csv:2: column 'mass_kg': found 'nan'"},
      {{"length_m,mass_kg\n1\n"}, "m.csv:2: found 1 columns, allowed 2"},
      {{"length_m,mass_kg\n"}, "found no rows"},
      {{"length_m,mass_kg\n1,8e-5\n1,8e-5\n"}, "found 2 rows, allowed 3 or more"},
      {{"angle_deg,low_N,high_N\n180,1,0.9\n"}, "m.csv:2: column 'high_N': found 0.9, allowed above low_N, which is 1"},
      {{weigh, "length_m,sag_m\n0.1,0.2\n"}, "m.csv:2: column 'sag_m': found 0.2, allowed below length_m"},
      {{"length_m,sag_m\n0.1,0.02\n0.1,0.02\n0.1,0.02\n"}, "found no file that tells density_kg_per_m"},
      {{"load_N,length_m\n1,0.5\n1,0.5\n1,0.5\n"}, "found one load_N, allowed 2 or more different ones"},
      {{weigh, "length_m,swings,time_s,start_m,end_m\n0.1,1,0.2,0.01,0.02\n"}, "allowed below start_m, which is 0.01"}};
  for (const auto& [texts, says] : cases) {
    const auto line = refusal_of(texts);
    EXPECT_NE(line.find(says), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
  EXPECT_EQ(refusal_of({weigh}), "accepted");
  EXPECT_EQ(refusal_of({"\xEF\xBB\xBF# by hand\n length_m , mass_kg\r\n1,8e-5\r\n1,8e-5 # wet\r\n1,8e-5\r\n"}),
            "accepted");
}

}  // namespace
}  // namespace ligature::fit
