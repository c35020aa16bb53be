// Encoder watch at several thresholds: false alarms per hour with healthy hands, and reversed axes that it misses.
// Usage: encoder_watch_study [hours = 100] [reversals = 1000] [first seed = 1]; prints tables of
// docs/measurements/encoder-watch.md.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "firmware/control/encoder_watch.hpp"
#include "tests/support/honest_hands.hpp"
#include "tests/support/share.hpp"

namespace ligature {
namespace {

using control::EncoderWatch;
using test::HonestHand;
constexpr std::array kScales{0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.25, 1.5, 2.0};
constexpr std::array<bool, 3> kFree{true, true, true};
constexpr std::size_t kShipped = 5;  // index of the scale 1.0
// A reversal that is not found in kLookTicks samples is missed; what it can do is looked at for kHarmTicks.
constexpr int kRunTicks = 5000, kLookTicks = 60, kHarmTicks = 500;
using Hits = std::array<int, kScales.size()>;

void count(double most, Hits& hits) {
  for (std::size_t i = 0; i < kScales.size(); ++i) hits[i] += most >= kScales[i];
}

/// Number of 5 s runs of a healthy hand that raise a false alarm: "axis reversed" (for each threshold), and "axis
/// frozen".
struct Honest {
  Hits reversed{};
  int frozen = 0, runs = 0;
};
Honest honest(HonestHand::Kind kind, double hours, std::uint64_t seed) {
  Honest h;
  for (h.runs = 0; h.runs < static_cast<int>(hours * 720.0); ++h.runs) {
    HonestHand hand(kind, seed + 7 * static_cast<std::uint64_t>(h.runs));
    EncoderWatch watch;
    double most = 0.0;
    bool frozen = false;
    for (int t = 0; t < kRunTicks; ++t) {
      const auto fault = watch.add(hand.next(), 1, kFree).fault;
      frozen = frozen || fault == control::Fault::kEncoderFrozen;
      most = std::max(most, watch.reversal(kFree).strength);
    }
    count(most, h.reversed);
    h.frozen += frozen;
  }
  return h;
}

/// Lower class limits, counts per period: axes that start to count backwards are classed by their speed at that moment.
constexpr std::array kClasses{0.0, 0.44, 0.6, 0.85, 1.4};
struct Reversed {
  std::array<Hits, kClasses.size()> found{};
  std::array<int, kClasses.size()> draws{};
  std::vector<int> ticks;
  std::vector<double> harm_mJ;  ///< of each reversal that the shipped detector misses

  void add(const Reversed& other) {
    for (std::size_t c = 0; c < kClasses.size(); ++c) {
      draws[c] += other.draws[c];
      for (std::size_t i = 0; i < kScales.size(); ++i) found[c][i] += other.found[c][i];
    }
    ticks.insert(ticks.end(), other.ticks.begin(), other.ticks.end());
    harm_mJ.insert(harm_mJ.end(), other.harm_mJ.begin(), other.harm_mJ.end());
  }
  [[nodiscard]] int missed(std::size_t c, std::size_t scale) const { return draws[c] - found[c][scale]; }
};

/// Upper bound of the energy in mJ that the motor of a joint gives in the kHarmTicks after this count: an Omni's peak
/// force at the tip, along the whole way that the joint moves.
double most_given_mJ(HonestHand& hand, std::size_t joint, double count) {
  constexpr double kPeak_N = 3.3, kCount_mm = 0.05;
  double way = 0.0;
  for (int t = 0; t < kHarmTicks; ++t) {
    const double next = hand.next()[joint];
    way += std::abs(next - count);
    count = next;
  }
  return kPeak_N * kCount_mm * way;
}

Reversed reversed(HonestHand::Kind kind, int draws, std::uint64_t seed) {
  Reversed r;
  for (int k = 0; k < draws; ++k) {
    test::Random random(seed + 11 * static_cast<std::uint64_t>(k));
    HonestHand hand(kind, random()), after = hand;  // after: the same hand, kept at the onset
    const int onset = static_cast<int>(random.any(1000, 4000));
    const std::size_t joint = random.below(3);
    EncoderWatch watch;
    std::vector<double> told;
    double most = 0.0, x0 = 0.0;
    for (int t = 0; t <= onset + kLookTicks; ++t) {
      auto counts = hand.next();
      told.push_back(counts[joint]);
      if (t == onset) x0 = counts[joint], after = hand;
      if (t > onset) counts[joint] = 2.0 * x0 - counts[joint];
      (void)watch.add(counts, 1, kFree);
      if (t <= onset) continue;
      if (most < 1.0 && watch.reversal(kFree).strength >= 1.0) r.ticks.push_back(t - onset);
      most = std::max(most, watch.reversal(kFree).strength);
    }
    const auto at = static_cast<std::size_t>(onset);
    const double speed = std::abs(told[at + 6] - told[at - 6]) / 12.0;
    std::size_t c = 0;
    while (c + 1 < kClasses.size() && speed >= kClasses[c + 1]) ++c;
    ++r.draws[c];
    count(most, r.found[c]);
    if (most < 1.0) r.harm_mJ.push_back(most_given_mJ(after, joint, x0));
  }
  return r;
}

void print_honest(double hours, std::uint64_t seed) {
  std::printf("| threshold |");
  for (const double scale : kScales) std::printf(" x %g |", scale);
  std::printf(" fault 22 |\n|---|");
  for (std::size_t i = 0; i <= kScales.size(); ++i) std::printf("---|");
  Honest all;
  const double each_h = hours / HonestHand::kKinds.size();
  for (const auto kind : HonestHand::kKinds) {
    const Honest h = honest(kind, each_h, seed += 100'000'007);
    std::printf("\n| %s, %.0f h |", HonestHand::name(kind), each_h);
    for (std::size_t i = 0; i < kScales.size(); ++i)
      all.reversed[i] += h.reversed[i], std::printf(" %d |", h.reversed[i]);
    std::printf(" %d |", h.frozen);
    std::fflush(stdout);
    all.frozen += h.frozen;
  }
  std::printf("\n| all, in 100 h |");
  for (const int n : all.reversed) std::printf(" %s |", test::rate(n, hours, 100.0).c_str());
  std::printf(" %s |\n\n", test::rate(all.frozen, hours, 100.0).c_str());
}

std::string missed(const Reversed& r, std::size_t c, std::size_t scale) {
  return test::share(r.missed(c, scale), r.draws[c]);
}

/// Missed reversals by speed of the joint, for all kinds of hand together.
void print_by_speed(const Reversed& all) {
  std::printf("| speed, counts a period | draws |");
  for (const double scale : kScales) std::printf(" x %g |", scale);
  std::printf("\n|---|---|");
  for (std::size_t i = 0; i < kScales.size(); ++i) std::printf("---|");
  for (std::size_t c = 0; c < kClasses.size(); ++c) {
    std::printf("\n| from %.2f | %d |", kClasses[c], all.draws[c]);
    for (std::size_t i = 0; i < kScales.size(); ++i) std::printf(" %s |", missed(all, c, i).c_str());
  }
}

/// Reversals that the shipped detector misses, for one kind of hand.
void print_kind(HonestHand::Kind kind, Reversed& r) {
  int draws = 0, all = 0;
  std::printf("| %s |", HonestHand::name(kind));
  for (std::size_t c = 0; c < kClasses.size(); ++c) {
    std::printf(" %s of %d |", missed(r, c, kShipped).c_str(), r.draws[c]);
    draws += r.draws[c], all += r.missed(c, kShipped);
  }
  std::ranges::sort(r.harm_mJ);
  const double median = r.harm_mJ.empty() ? 0.0 : r.harm_mJ[r.harm_mJ.size() / 2];
  std::printf(" %s | %.1f | %.1f |\n", test::share(all, draws).c_str(), median,
              r.harm_mJ.empty() ? 0.0 : r.harm_mJ.back());
}

void print_reversed(int draws, std::uint64_t seed) {
  std::printf("| hand |");
  for (const double from : kClasses) std::printf(" from %.2f: missed, %% |", from);
  std::printf(" all, %% | most energy, median, mJ | largest |\n|---|---|---|---|---|---|---|---|---|\n");
  Reversed all;
  const int each = draws / static_cast<int>(HonestHand::kKinds.size());
  for (const auto kind : HonestHand::kKinds) {
    Reversed r = reversed(kind, each, seed += 100'000'007);
    print_kind(kind, r);
    all.add(r);
  }
  std::printf("\n");
  print_by_speed(all);
  std::ranges::sort(all.ticks);
  if (!all.ticks.empty())
    std::printf("\n\nticks until told: median %d, most %d\n", all.ticks[all.ticks.size() / 2], all.ticks.back());
}

}  // namespace
}  // namespace ligature

int main(int argc, char** argv) {
  const double hours = argc > 1 ? std::atof(argv[1]) : 100.0;
  const int reversals = argc > 2 ? std::atoi(argv[2]) : 1000;
  const auto seed = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1ULL;
  ligature::print_honest(hours, seed);
  ligature::print_reversed(reversals, seed + 900'000'011ULL);
}
