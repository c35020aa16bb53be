#include "host/lab/tie/tie_command.hpp"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdio>
#include <memory>

#include "host/console/stop_signal.hpp"
#include "host/lab/outcome.hpp"
#include "host/lab/rehearsal.hpp"
#include "host/lab/run_files.hpp"
#include "host/lab/tie/tie_once.hpp"

namespace ligature::lab {
namespace {

constexpr double kEnough = 0.95;
constexpr const char *kScene = "scenes/paper.toml", *kLongScene = "scenes/paper-long.toml";

struct Arguments {
  std::string knot = "overhand";
  std::string scene;
  std::vector<std::string> overrides;
  std::string seeds = "1-20";
  std::string out = "out/tie";
};

constexpr const char* kFooter = R"(
An operator who looks at the thread 100 times a second ties the knot with two simulated devices: encoder counts, CAN
frames, coupling, torque, all on a simulated clock. Each run's recording (DIR/KNOT-SEED.lcmlog, what `ligature-host
record` would have written) is read back, and the knot in its last shape, five seconds after the hands let go, counts.

Exit: 0 done; 2 knot, scene or seeds refused; 3 fewer than 95 % tied.

Example:
  ligature-lab tie overhand --scene scenes/suture-3-0.toml --seeds 1-20 --out out/tie)";

struct Seeds {
  std::uint32_t first = 1, last = 1;
};

Seeds read_seeds(const std::string& text) {
  Seeds s;
  const char* end = text.data() + text.size();
  auto [at, error] = std::from_chars(text.data(), end, s.first);
  s.last = s.first;
  bool good = error == std::errc{};
  if (good && at != end) {
    const auto rest =
        *at == '-' ? std::from_chars(at + 1, end, s.last) : std::from_chars_result{at, std::errc::invalid_argument};
    good = rest.ec == std::errc{} && rest.ptr == end;
  }
  if (!good || s.last < s.first || s.last - s.first >= 10'000) {
    throw Refusal("--seeds: found \"" + text + "\", allowed N or FIRST-LAST, rising, at most 10000 of them");
  }
  return s;
}

int execute(const Arguments& a) {
  const Seeds seeds = read_seeds(a.seeds);
  const std::string file = !a.scene.empty() ? a.scene : a.knot.starts_with("surgeon") ? kLongScene : kScene;
  const auto scene = load_scene_or_refuse(file, a.overrides);
  (void)make_or_refuse(scene, file);
  make_folder(a.out);
  int tied = 0, tried = 0;
  std::printf("%6s  %-20s %8s  %s\n", "seed", "found", "seconds", "moves given up");
  for (std::uint32_t seed = seeds.first; seed <= seeds.last && !console::stop_requested(); ++seed) {
    const Tied t = tie_once(scene, file, a.knot, seed, a.out);
    ++tried;
    tied += t.good();
    std::string missed;
    for (const auto& m : t.missed) missed += (missed.empty() ? "" : ", ") + m;
    std::printf("%6u  %-20s %8.1f  %s\n", seed, t.found.c_str(), t.seconds, missed.c_str());
    std::fflush(stdout);
  }
  std::printf("%s: tied %d of %d\n", a.knot.c_str(), tied, tried);
  return tried > 0 && tied >= kEnough * tried ? kDone : kRunFailed;
}

}  // namespace

void add_tie_command(CLI::App& app, int& exit_code) {
  auto* tie = app.add_subcommand("tie", "Knots tied by an operator that looks, through the whole chain, and counted");
  auto a = std::make_shared<Arguments>();
  tie->add_option("knot", a->knot, "Which knot; an unknown one is answered with those there are")->required();
  tie->add_option("--scene", a->scene, "Scene file (TOML); its node 0 must be fixed")
      ->default_str("scenes/paper.toml; for surgeon scenes/paper-long.toml");
  tie->add_option("--set", a->overrides, "key=value over the scene's own; repeatable")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  tie->add_option("--seeds", a->seeds, "N or FIRST-LAST: another operator each")->capture_default_str();
  tie->add_option("--out", a->out, "Folder for the recordings")->type_name("DIR")->capture_default_str();
  tie->footer(kFooter);
  tie->callback([a, &exit_code] { exit_code = execute(*a); });
}

}  // namespace ligature::lab
