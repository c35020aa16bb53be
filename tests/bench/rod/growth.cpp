// Cost of a tick by number of nodes, for an equally spaced 0.3 mm suture: swinging from level, held at one end, without
// and with contact, and drawn along by both hands at 1 m/s. Prints per tick: thread CPU time and, for the last two,
// contact work in instructions (rod/work.hpp), pairs on the contact list, and how often that list was built.
//
// Usage: rod_growth [nodes ...]   (default 50 100 200 256 512 1024 2000)
// For instruction counts: valgrind --tool=callgrind --toggle-collect='*Rod::tick*' rod_growth 1024

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "firmware/physics/rod/rod.hpp"
#include "host/lab/cpu_time.hpp"

using namespace ligature::physics::rod;

namespace {

constexpr int kTicks = 60;

enum class What { kFree, kContact, kDrawn };

void run(int nodes, What what) {
  Rod rod(Material{}, Numerics{}, Parts{true, what != What::kFree, what != What::kFree, false, false}, nodes);
  rod.gravity = make(0, 0, -9.81);
  std::array<Vec, kMaxHolds> goals{};
  goals[0] = rod.state().x.front(), goals[1] = rod.state().x.back();
  if (what == What::kDrawn) {
    rod.grip(0, 500.0, 0.5, goals[0]);
    rod.grip(nodes - 1, 500.0, 0.5, goals[1]);
  } else {
    rod.support(0, goals[0]);
  }
  std::vector<double> us;
  long work = 0, most = 0, lists = 0;
  double lost = 0.0;
  std::size_t pairs = 0;
  for (int k = 0; k < kTicks; ++k) {
    if (what == What::kDrawn) goals[0] += make(1e-3, 0, 0), goals[1] += make(1e-3, 0, 0);
    const double before = ligature::lab::thread_cpu_us();
    rod.tick(goals);
    us.push_back((ligature::lab::thread_cpu_us() - before) / rod.report().substeps / nodes);
    work += rod.report().work;
    most = std::max(most, rod.report().work);
    lists += rod.report().broad_phases;
    lost += rod.report().time_lost;
    pairs = std::max(pairs, rod.contact_set().pairs.size());
  }
  std::sort(us.begin(), us.end());
  static constexpr const char* kNames[] = {"no contact", "contact", "drawn"};
  std::printf("%5d nodes %-10s ns/node/substep median %5.1f p90 %5.1f", nodes, kNames[static_cast<int>(what)],
              1e3 * us[us.size() / 2], 1e3 * us[us.size() * 9 / 10]);
  if (what != What::kFree) {
    std::printf("  work k mean %.0f most %ld  pairs %zu  lists/tick %.2f  ticks lost %.2f",
                1e-3 * static_cast<double>(work) / kTicks, most / 1000, pairs, static_cast<double>(lists) / kTicks,
                lost);
  }
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<int> all{50, 100, 200, 256, 512, 1024, 2000};
  if (argc > 1) all.clear();
  for (int k = 1; k < argc; ++k) all.push_back(std::atoi(argv[k]));
  for (const int nodes : all) {
    if (nodes < 4) return std::fprintf(stderr, "nodes: found %d, allowed 4 or more\n", nodes), 2;
    for (const What what : {What::kFree, What::kContact, What::kDrawn}) run(nodes, what);
  }
}
