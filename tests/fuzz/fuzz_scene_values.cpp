// Scenes with extreme values for their keys. Every scene that the reader accepts is built or rejected; a built one is
// stepped, and its state must stay finite or be reported as not finite.
//   fuzz_scene_values [TRIALS [SEED]]     the same SEED gives the same scenes; exit code 0 and counts if all held
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>
#include <vector>

#include "firmware/physics/simulation.hpp"
#include "protocol/scene/scene_file.hpp"
#include "tests/fuzz/target.hpp"
#include "tests/support/random.hpp"

namespace {

using ligature::physics::Simulation;
using ligature::physics::ToolInput;
using ligature::physics::Vec3;

enum class Kind { kNumber, kInteger, kFixed, kDirection, kLoad, kPeg, kVector };
struct Key {
  const char* name;
  Kind kind = Kind::kNumber;
};

constexpr Key kOfAll[] = {{"suture.length_m"},
                          {"suture.radius_m"},
                          {"suture.nodes", Kind::kInteger},
                          {"suture.air_drag_per_s"},
                          {"contact.friction"},
                          {"contact.static_friction"},
                          {"world.gravity_m_per_s2", Kind::kVector},
                          {"world.fixed", Kind::kFixed},
                          {"world.fixed", Kind::kDirection},
                          {"world.loads", Kind::kLoad},
                          {"world.desk_height_m"},
                          {"time.tick_s"},
                          {"time.substeps", Kind::kInteger},
                          {"hands.coupling_N_per_m"},
                          {"hands.coupling_N_s_per_m"},
                          {"hands.reach_m"}};
constexpr Key kOfPaper[] = {{"suture.node_mass_kg"},
                            {"suture.stretch_N"},
                            {"suture.stretch_damping"},
                            {"suture.bend"},
                            {"suture.bend_damping"},
                            {"suture.swivel_damping"},
                            {"suture.reference_nodes", Kind::kInteger},
                            {"contact.repulsion_N_per_m"},
                            {"contact.repulsion_N_s_per_m"},
                            {"hands.min_length"},
                            {"hands.max_length"}};
constexpr Key kOfRod[] = {{"suture.density_kg_per_m"},
                          {"suture.EA_N"},
                          {"suture.EI_N_m2"},
                          {"suture.GJ_N_m2"},
                          {"suture.rest_curvature_per_m"},
                          {"suture.rest_twist_per_m"},
                          {"suture.yield_strain"},
                          {"suture.set_fraction"},
                          {"suture.damping_s"},
                          {"suture.stretch_damping_s"},
                          {"hands.pinch_width_m"},
                          {"hands.pinch_force_N"},
                          {"world.pegs", Kind::kPeg}};
const std::vector<std::string> kPaperWords[] = {
    {"suture.model=paper-1", "suture.model=paper-2", "suture.model=paper-3", "suture.model=paper-4",
     "suture.model=paper-5"},
    {"contact.solver=none", "contact.solver=paper", "contact.solver=implicit"},
    {"suture.damping=implicit", "suture.damping=explicit"},
    {"suture.integrator=semi-implicit", "suture.integrator=forward"},
    {"suture.swivel=internal", "suture.swivel=paper"},
    {"contact.broad_phase=auto", "contact.broad_phase=sweep", "contact.broad_phase=bvh"},
    {"hands.propagation=false", "hands.propagation=true"}};
const std::vector<std::string> kRodWords[] = {{"contact.solver=none", "contact.solver=implicit"},
                                              {"suture.spacing=uniform", "suture.spacing=adaptive"},
                                              {"contact.turns_thread=false", "contact.turns_thread=true"},
                                              {"suture.accuracy=fast", "suture.accuracy=balanced"}};

class Wild {
 public:
  explicit Wild(std::uint64_t seed) : random_(seed) {}
  int below(std::size_t n) { return static_cast<int>(random_() % n); }

  /// A random number: mostly between 1e-13 and 1e13, sometimes at the ends of the range of a double or beyond,
  /// sometimes negative.
  std::string number() {
    constexpr const char* kOdd[] = {"0.0", "5e-324", "1e-300", "1e-9", "1e-6", "1e-3", "1.0",     "1e2",
                                    "1e3", "1e4",    "1e5",    "1e6",  "1e9",  "1e12", "1.7e308", "-1e-3"};
    if (below(3) == 0) return kOdd[below(std::size(kOdd))];
    char text[40];
    const double decade = random_.in(-13.0, 13.0);
    const double sign = below(8) == 0 ? -1.0 : 1.0;
    std::snprintf(text, sizeof text, "%.17e", sign * std::pow(10.0, decade));
    return text;
  }
  std::string integer() {
    constexpr int kOdd[] = {-1, 0, 1, 2, 3, 4, 5, 7, 8, 9, 16, 17, 50, 400, 1000, 5000};
    return std::to_string(kOdd[below(std::size(kOdd))]);
  }
  std::string vector() {
    const std::string three[]{number(), number(), number()};  // braces: the order of evaluation is defined
    return "[" + three[0] + ", " + three[1] + ", " + three[2] + "]";
  }
  std::string value(Kind kind) {
    switch (kind) {
      case Kind::kNumber:
        return number();
      case Kind::kInteger:
        return integer();
      case Kind::kVector:
        return vector();
      case Kind::kFixed:
        return "[{node = 0, position_m = " + vector() + "}]";
      case Kind::kDirection:
        return "[{node = 1, position_m = [0.0, 0.0, 1.0], direction = " + vector() + "}]";
      case Kind::kLoad:
        return "[{node = -1, force_N = " + vector() + "}]";
      case Kind::kPeg:
        return peg();
    }
    return {};
  }

  std::string peg() {
    const std::string parts[]{vector(), vector(), number()};
    const std::string turns = below(2) == 0 ? ", surface_m_per_s = " + number() : "";
    return "[{from_m = " + parts[0] + ", to_m = " + parts[1] + ", radius_m = " + parts[2] + turns + "}]";
  }

  std::vector<std::string> scene() {
    std::vector<std::string> all;
    const bool rod = below(2) == 0;
    const auto words = rod ? std::span<const std::vector<std::string>>(kRodWords) : kPaperWords;
    const auto keys = rod ? std::span<const Key>(kOfRod) : kOfPaper;
    all.emplace_back("suture.nodes=12");
    if (rod) all.insert(all.end(), {"suture.model=rod", "suture.length_m=0.2", "suture.radius_m=1e-3"});
    for (const auto& choice : words)
      if (below(2) == 0) all.push_back(choice[static_cast<std::size_t>(below(choice.size()))]);
    for (int n = 1 + below(3); n > 0; --n) {
      const Key key =
          below(2) == 0 ? keys[static_cast<std::size_t>(below(keys.size()))] : kOfAll[below(std::size(kOfAll))];
      all.push_back(std::string(key.name) + "=" + value(key.kind));
    }
    return all;
  }

 private:
  ligature::test::Random random_;
};

[[noreturn]] void fail(const std::vector<std::string>& scene, const char* what) {
  std::fprintf(stderr, "fuzz_scene_values: %s with", what);
  for (const auto& s : scene) std::fprintf(stderr, " --set '%s'", s.c_str());
  std::fprintf(stderr, "\n");
  std::exit(1);
}

/// @return whether the state stayed finite for ten ticks, with both hands holding the thread.
bool ticks(Simulation& thread, const std::vector<std::string>& scene) {
  const auto n = thread.nodes_W().size();
  const Vec3 at[2] = {thread.nodes_W()[n / 3], thread.nodes_W()[2 * n / 3]};
  for (int k = 0; k < 10; ++k) {
    thread.tick({ToolInput{at[0], Vec3::Zero(), true}, ToolInput{at[1], Vec3::Zero(), true}});
    for (const auto& p : thread.nodes_W())
      if (!p.allFinite()) fail(scene, "a node that is no number");
    for (const auto hand : {ligature::physics::Hand::kLeft, ligature::physics::Hand::kRight})
      if (!thread.hand(hand).f_W.allFinite()) fail(scene, "a force that is no number");
    if (!thread.diagnostics().finite) return false;  // reported; the firmware rejects such a scene in a trial run
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  const int trials = argc > 1 ? std::atoi(argv[1]) : 1000;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  std::printf("seed %llu, LIGATURE_TEST_SEED=%llu\n", static_cast<unsigned long long>(seed),
              static_cast<unsigned long long>(ligature::test::seed_shift()));
  std::fflush(stdout);
  constexpr int kMostWork = 20'000;  // nodes x substeps; the firmware's trial run rejects slower scenes
  Wild wild(seed);
  const ligature::fuzz::MemoryFile empty(reinterpret_cast<const std::uint8_t*>("[suture]\n"), 9);
  int taken = 0, built = 0, finite = 0;
  for (int i = 0; i < trials; ++i) {
    const auto scene = wild.scene();
    const auto read = ligature::scene::load_scene(empty.path(), scene);
    const auto* good = std::get_if<ligature::scene::Scene>(&read);
    if (good == nullptr || good->suture.nodes * good->time.substeps > kMostWork) continue;
    ++taken;
    std::fprintf(stderr, "\r");
    auto made = Simulation::make(*good);
    if (auto* thread = std::get_if<Simulation>(&made)) ++built, finite += ticks(*thread, scene);
  }
  std::printf("%d scenes: %d taken, %d built, %d finite after 10 ticks\n", trials, taken, built, finite);
  return 10 * finite < trials ? 1 : 0;  // a test in which hardly any scene ran would prove nothing
}
