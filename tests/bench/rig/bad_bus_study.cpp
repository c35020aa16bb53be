// Random runs with lost or corrupted CAN frames, or a wrong encoder: the fault that ends each run, the time until no
// motor has torque, and the true force. Prints the tables of docs/measurements/fault-matrix.md.
// Usage: bad_bus_study [runs per row = 300] [first seed = 1] [encoders | lost | wrong]; default: all three tables
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string_view>
#include <vector>

#include "tests/integration/virtual_rig/bad_bus.hpp"
#include "tests/support/share.hpp"

namespace ligature {
namespace {

struct Tally {
  std::map<int, int> faults;
  std::vector<std::int64_t> to_zero;
  double peak_N = 0.0;
  int draws = 0, pushed_after = 0;
};

Tally tally(const BadBus& bus, int draws, std::uint64_t first_seed) {
  Tally t;
  for (int k = 0; k < draws; ++k, ++t.draws) {
    BadBus one = bus;
    if (bus.left != bus.right) one.left = k % 2 == 0, one.right = !one.left;  // alternate left, right
    const BadBusEnd end = end_of(one, first_seed + 1000 * static_cast<std::uint64_t>(k));
    ++t.faults[end.fault];
    if (end.fault != 0) t.to_zero.push_back(end.to_zero);
    t.peak_N = std::max(t.peak_N, end.peak_N);
    t.pushed_after += end.pushed_after;
  }
  std::ranges::sort(t.to_zero);
  return t;
}

int others(const Tally& t, std::vector<int> named) {
  int sum = 0;
  for (const auto& [fault, times] : t.faults) sum += std::ranges::count(named, fault) == 0 ? times : 0;
  return sum;
}

void print_times(const Tally& t) {
  if (t.to_zero.empty())
    std::printf(" | | | %.2f |\n", t.peak_N);
  else
    std::printf(" | %lld | %lld | %.2f |\n", static_cast<long long>(t.to_zero[t.to_zero.size() / 2]),
                static_cast<long long>(t.to_zero.back()), t.peak_N);
  if (t.pushed_after > 0) std::printf("TORQUE AFTER A FAULT: %d\n", t.pushed_after);
  std::fflush(stdout);
}

void lost(int draws, std::uint64_t seed) {
  std::printf(
      "| frames lost, %% | hands | no fault, %% | fault 17, %% | fault 11, %% | others, %% | median | worst | true "
      "force, N |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  std::vector<int> shares{0, 1};
  for (int percent = 5; percent <= 100; percent += 5) shares.push_back(percent);
  for (const int percent : shares) {
    for (const bool both : {false, true}) {
      const std::int64_t ticks = percent < 15 ? 1000 : percent < 25 ? 2200 : 300;
      const Tally t = tally({.lost = 0.01 * percent, .left = true, .right = both, .ticks = ticks}, draws, seed);
      auto count = [&](int fault) { return t.faults.contains(fault) ? t.faults.at(fault) : 0; };
      std::printf("| %d | %s | %s | %s | %s | %s", percent, both ? "both" : "one", test::share(count(0), draws).c_str(),
                  test::share(count(17), draws).c_str(), test::share(count(11), draws).c_str(),
                  test::share(others(t, {0, 11, 17}), draws).c_str());
      print_times(t);
      seed += 1'000'003;
    }
  }
}

void wrong(int draws, std::uint64_t seed) {
  std::printf(
      "\n| frames with a wrong bit, %% | no fault, %% | fault 21, %% | fault 12, %% | others, %% | median | worst | "
      "true force, N "
      "|\n|---|---|---|---|---|---|---|---|\n");
  for (const double percent : {0.1, 1.0, 10.0}) {
    const Tally t = tally({.wrong = 0.01 * percent, .ticks = 1500}, draws, seed);
    auto count = [&](int fault) { return t.faults.contains(fault) ? t.faults.at(fault) : 0; };
    std::printf("| %g | %s | %s | %s | %s", percent, test::share(count(0), draws).c_str(),
                test::share(count(21), draws).c_str(), test::share(count(12), draws).c_str(),
                test::share(others(t, {0, 12, 21}), draws).c_str());
    print_times(t);
    seed += 1'000'003;
  }
}

void encoders(int draws, std::uint64_t seed) {
  std::printf(
      "| encoder | axis | no fault, %% | fault 22, %% | fault 23, %% | others, %% | true force, N | true step, N |\n"
      "|---|---|---|---|---|---|---|---|\n");
  struct Row {
    const char *what, *axis;
    WrongEncoder encoder;
  };
  std::vector<Row> rows{{"all are right", "-", {}}};
  constexpr std::array kAxes{"waist", "shoulder", "forearm"};
  const std::vector<std::pair<const char*, WrongEncoder>> kinds{
      {"stands still", {scene::FaultKind::kFreeze}},
      {"counts backwards", {scene::FaultKind::kReverse}},
      {"is off by 30 counts, 1.5 mm", {scene::FaultKind::kJump, 0, 30}}};
  for (auto [what, encoder] : kinds)
    for (encoder.node = 1; encoder.node <= 3; ++encoder.node)
      rows.push_back({what, kAxes[static_cast<std::size_t>(encoder.node - 1)], encoder});
  for (const Row& row : rows) {
    Tally t;
    double step_N = 0.0;
    for (; t.draws < draws; ++t.draws) {
      const WrongEncoderEnd end = end_of(row.encoder, seed + 1000 * static_cast<std::uint64_t>(t.draws));
      ++t.faults[end.fault];
      t.peak_N = std::max(t.peak_N, end.peak_N), step_N = std::max(step_N, end.step_N);
    }
    std::printf("| %s | %s | %s | %s | %s | %s | %.2f | %.2f |\n", row.what, row.axis,
                test::share(t.faults[0], draws).c_str(), test::share(t.faults[22], draws).c_str(),
                test::share(t.faults[23], draws).c_str(), test::share(others(t, {0, 22, 23}), draws).c_str(), t.peak_N,
                step_N);
    std::fflush(stdout);
    seed += 1'000'003;
  }
  std::printf("\n");
}

}  // namespace
}  // namespace ligature

int main(int argc, char** argv) {
  const int draws = argc > 1 ? std::max(1, std::atoi(argv[1])) : 300;
  const auto seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1ULL;
  const std::string_view table = argc > 3 ? argv[3] : "all";
  if (table == "all" || table == "encoders") ligature::encoders(draws, seed + 700'000'001ULL);
  if (table == "all" || table == "lost") ligature::lost(draws, seed);
  if (table == "all" || table == "wrong") ligature::wrong(draws, seed + 500'000'009ULL);
}
