// Pulls both ends of a scene's thread. In every EVERY-th tick the physics asks clock_query() for the time.
// test_pieces.py runs this program under callgrind, which writes out its instruction count at each call of
// pieces_begin() and of clock_query().
//
// Usage: thread-pieces SCENE TICKS EVERY [KEY=VALUE ..]

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <variant>
#include <vector>

#include "firmware/physics/simulation.hpp"
#include "firmware/platform/realtime.hpp"
#include "protocol/scene/scene_file.hpp"

using namespace ligature;

// Callgrind finds both functions by these names.
extern "C" {
/// A clock whose time is never over.
__attribute__((noinline)) std::int64_t clock_query(void* queries) noexcept {
  ++*static_cast<long*>(queries);
  return std::int64_t{1} << 60;
}
/// What was executed before this call belongs to no piece.
__attribute__((noinline)) void pieces_begin() noexcept { asm volatile(""); }
}

int main(int argc, char** argv) {
  if (argc < 4) return std::fprintf(stderr, "usage: thread-pieces SCENE TICKS EVERY [KEY=VALUE ..]\n"), 2;
  const auto loaded = scene::load_scene(argv[1], std::vector<std::string>(argv + 4, argv + argc));
  if (const auto* error = std::get_if<scene::Error>(&loaded))
    return std::fprintf(stderr, "%s\n", error->text.c_str()), 2;
  auto made = physics::Simulation::make(std::get<scene::Scene>(loaded));
  if (const auto* why = std::get_if<std::string>(&made)) return std::fprintf(stderr, "%s\n", why->c_str()), 2;
  auto& thread = std::get<physics::Simulation>(made);
  platform::flush_denormals();
  const int ticks = std::atoi(argv[2]), every = std::atoi(argv[3]);
  const std::array<physics::Vec3, 2> ends{thread.nodes_W().front(), thread.nodes_W().back()};
  const physics::Vec3 along = (ends[1] - ends[0]).normalized();
  constexpr double kSpeed_m_per_s = 0.2, kTick_s = 1e-3;
  long queries = 0;
  int contacts = 0;
  for (int k = 0; k < ticks; ++k) {
    const bool grips = k > 2;
    const physics::Vec3 gone = kSpeed_m_per_s * kTick_s * k * along, speed = kSpeed_m_per_s * along;
    const bool asks = k % every == every - 1;
    if (asks) pieces_begin();
    thread.tick({physics::ToolInput{ends[0] - gone, -speed, grips}, physics::ToolInput{ends[1] + gone, speed, grips}},
                asks ? physics::TimeLeft(&clock_query, &queries) : physics::TimeLeft{});
    if (asks) contacts = std::max(contacts, thread.diagnostics().contacts);
  }
  std::printf("%ld queries, %d contacts\n", queries, contacts);
}
