#include "sim_device/options.hpp"

#include <CLI/CLI.hpp>
#include <iostream>

namespace ligature::sim {
namespace {

constexpr const char* kAbout =
    "One simulated haptic hand: three CiA 402 drives on a CAN bus, the mechanics they turn, and a human hand that\n"
    "follows a script. It answers a controller as hardware would: the bus takes its time, encoders count, torque acts\n"
    "one SYNC later, and the drives take torque away by themselves when the controller falls silent.";
constexpr const char* kExample =
    "Example, with ligature-firmware started the same way on the other end:\n"
    "  ligature-device --hand left --bus local:/tmp/left --scene scenes/paper.toml --operator "
    "scenes/operators/overhand.csv\n"
    "The script starts when all three drives are enabled for the first time and SYNC runs. The operator holds the\n"
    "dead-man from then until 1 s after the last key. docs/wire.md describes the bus.\n"
    "A hand that a person moves with mouse, keys or gamepad:  ... --operator page, and ligature-host view "
    "(docs/view.md)\n"
    "Both hands of an operator who ties by looking at what the rig publishes on LCM:  ... --operator tie:square:7 "
    "(docs/tying.md)\n"
    "A clenched, trembling hand:  ... --hold clenched --tremor-mm 0.5 --tremor-hz 9\n"
    "Exit: 0 ended (SIGINT, SIGTERM or script), 2 bad usage or input, 3 the run failed.";

/// CLI::Range accepts nan, because every comparison with nan is false; this validator refuses it.
CLI::Validator within(double low, double high) {
  return {[=](const std::string& word) {
            double value = 0.0;
            const bool good = CLI::detail::lexical_cast(word, value) && value >= low && value <= high;
            return good ? std::string()
                        : "found '" + word + "', allowed " + CLI::detail::to_string(low) + " .. " +
                              CLI::detail::to_string(high);
          },
          "FLOAT in [" + CLI::detail::to_string(low) + " - " + CLI::detail::to_string(high) + "]"};
}

/// Refuses an empty name of a file: it would silently count as if the option was not given.
std::string not_empty(const std::string& name) { return name.empty() ? "found '', allowed a name" : ""; }

}  // namespace

std::optional<Hand> hand_of(const std::string& hold) {
  if (hold.empty() || hold == "light") return Hand{};
  if (hold == "none") return Hand::absent();
  if (hold == "loose") return Hand::holding(0.0);
  if (hold == "firm") return Hand::holding(0.5);
  if (hold == "clenched") return Hand::holding(1.0);
  try {
    std::size_t used = 0;
    const double tightness = std::stod(hold, &used);
    if (used == hold.size() && tightness >= 0.0 && tightness <= 1.0) return Hand::holding(tightness);
  } catch (const std::exception&) {
    return std::nullopt;  // not a number
  }
  return std::nullopt;
}

std::variant<Options, int> parse_options(int argc, char** argv) {
  Options o;
  std::string hand;
  CLI::App app(kAbout, "ligature-device");
  app.footer(kExample);
  app.set_version_flag("--version", "ligature-device " LIGATURE_VERSION);
  app.add_option("--hand", hand, "Which hand of the script")->required()->check(CLI::IsMember({"left", "right"}));
  app.add_option("--bus", o.bus, "local:/path/socket (made and served here) or socketcan:interface")->required();
  app.add_option("--scene", o.scene, "Scene file; gives the workspace: hands.workspace_scale, hands.workspace_origin_m")
      ->check(not_empty);
  app.add_option("--set", o.overrides, "key=value over the scene, as often as needed")
      ->needs("--scene")
      ->allow_extra_args(false);
  app.add_option(
         "--operator", o.script,
         "Script, CSV: time,hand,x,y,z,grip in world metres; or the word page: a person moves the hand from the "
         "page of ligature-host view; or tie:KNOT[:SEED]: an operator ties overhand, figure-eight, square, granny or "
         "surgeon by looking at the thread; or untie[:SEED]: unties a loose knot in the same way; without it the hand "
         "rests")
      ->check(not_empty);
  app.add_option("--lcm-url", o.lcm_url, "LCM network of the rig, for --operator page, tie: and untie")
      ->capture_default_str();
  app.add_option("--faults", o.faults, "Fault script (TOML, see scenes/faults): what shall go wrong, and when")
      ->check(not_empty);
  app.add_flag("--exit-when-done", o.exit_when_done, "End after the script, once the dead-man is let go");
  app.add_option("--stats", o.stats, "At the end, write JSON: SYNCs, bus load, watchdog trips, final torque")
      ->check(not_empty);
  app.add_flag("--rt", o.real_time, "Ask for SCHED_FIFO and locked memory; runs on with a warning when refused");
  app.add_option("--cpu", o.cpu, "Stay on this CPU")->check(within(0, 1023));
  app.add_option(
         "--device", o.device,
         "Device record (TOML, see scenes/devices), also names the drives: CiA 402, ODrive, moteus; without it the "
         "Omni class")
      ->check(not_empty);
  const auto known_hold = [](const std::string& word) {
    return hand_of(word) ? std::string() : "found '" + word + "', allowed loose, light, firm, clenched, none or 0 .. 1";
  };
  app.add_option("--hold", o.hold,
                 "How the hand holds the stylus: loose, light, firm, clenched, none, or a tightness 0 .. 1 [light]")
      ->check(CLI::Validator(known_hold, "HOLD"));
  app.add_option("--tremor-mm", o.tremor_mm, "Amplitude by which the hand trembles")->check(within(0.0, 10.0));
  app.add_option("--tremor-hz", o.tremor_Hz, "How often")->check(within(0.1, 100.0))->capture_default_str();
  app.add_option("--adversary-s", o.adversary_lead_s,
                 "The hand works against the device: it pushes on in the direction of motion, so many seconds ahead")
      ->check(within(0.0, 1.0));
  app.add_option("--adversary-mm", o.adversary_reach_mm, "At most so far ahead")
      ->check(within(0.1, 100.0))
      ->capture_default_str();
  app.add_flag("--links-bend", o.links_bend, "Links of the class's stiffness between the encoders and the stylus");
  app.add_option("--gravity-share", o.gravity_share, "Share of the links' weight that nothing compensates")
      ->check(within(0.0, 1.0));
  app.add_option("--seed", o.seed, "Of the tremor's phases")->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);
    std::cerr << "ligature-device: " << e.what() << " (see --help)\n";
    return 2;
  }
  o.is_left = hand == "left";
  return o;
}

}  // namespace ligature::sim
