#include "firmware/app/options.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <cstdlib>
#include <map>

namespace ligature::app {
namespace {

constexpr const char* kAbout =
    "The controller of the rig: reads both hands over CAN, simulates the thread, gives the hands its force, 1000\n"
    "times a second, and tells about every period over LCM.";

constexpr const char* kRunHelp = R"(Runs until --duration, SIGINT or SIGTERM; then forces ramp to zero, the drives are
switched off and a table of the timing is printed. Force needs arming (--arm, or 'ligature-host send arm')
AND the dead-man button of the hand. A fault takes force off both hands at once, is latched, and is left by
'ligature-host send reset-fault'; docs/architecture.md lists the numbers.

Example, with two simulated hands already running:
  ligature-device --hand left  --bus local:/tmp/left  --scene scenes/paper.toml --operator scenes/operators/overhand.csv &
  ligature-device --hand right --bus local:/tmp/right --scene scenes/paper.toml --operator scenes/operators/overhand.csv &
  ligature-firmware run --scene scenes/paper.toml --left local:/tmp/left --right local:/tmp/right --arm --duration 23

Exit: 0 done, 2 bad usage or bad scene, 3 a fault ended the run, the scene does not fit into the period, or the rig
could not be started.)";

const std::map<std::string, RtMode> kModes{
    {"enforce", RtMode::kEnforce}, {"warn", RtMode::kWarn}, {"off", RtMode::kOff}};

/// Like CLI::Range, but refuses nan, which CLI::Range accepts because every comparison with nan is false.
CLI::Validator within(double low, double high) {
  const std::string allowed = CLI::detail::to_string(low) + " .. " + CLI::detail::to_string(high);
  return {[=](const std::string& word) {
            double value = 0.0;
            const bool good = CLI::detail::lexical_cast(word, value) && value >= low && value <= high;
            return good ? std::string() : "found '" + word + "', allowed " + allowed;
          },
          "in [" + allowed + "]"};
}

/// Refuses an empty name of a file or folder: it would silently count as if the option was not given.
std::string not_empty(const std::string& name) { return name.empty() ? "found '', allowed a name" : ""; }

/// Error text that names an unknown command. The library CLI11 would only say that a command is missing.
std::string unknown_command(const CLI::App& app, int argc, const char* const* argv) {
  if (argc < 2 || argv[1][0] == '-') return {};
  std::string allowed;
  for (const auto* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == argv[1]) return {};
    allowed += (allowed.empty() ? "" : ", ") + command->get_name();
  }
  return "found command '" + std::string(argv[1]) + "', allowed " + allowed;
}

void add_scene(CLI::App& command, std::string& scene, std::vector<std::string>& overrides) {
  command.add_option("--scene", scene, "scene file (TOML): the thread, its world, the coupling to the hands")
      ->required()
      ->check(not_empty);
  command.add_option("--set", overrides, "override a key of the scene: key=value, may be given again")
      ->allow_extra_args(false);
}

void add_budget(CLI::App& command, double& percent) {
  command
      .add_option("--budget", percent,
                  "share of the period that the loop may compute, percent; the thread's not counted")
      ->check(within(1.0, 100.0))
      ->capture_default_str();
}

void add_no_loss(CLI::App& command, double& speed) {
  command
      .add_option("--no-loss", speed,
                  "refuse a scene whose knot loses time when drawn so fast, m/s a hand (surgeons': to 0.4)")
      ->check(within(0.01, 0.4));
}

/// Default path of the flight recorder: the state directory of the XDG base directory specification, or "none".
std::string default_recorder() {
  if (const char* state = std::getenv("XDG_STATE_HOME"); state != nullptr && *state == '/')
    return std::string(state) + "/ligature/flight.rec";
  const char* home = std::getenv("HOME");
  return home != nullptr && *home == '/' ? std::string(home) + "/.local/state/ligature/flight.rec" : "none";
}

void add_run(CLI::App& run, RunOptions& o) {
  o.recorder = default_recorder();
  run.footer(kRunHelp);
  add_scene(run, o.scene, o.overrides);
  run.add_option("--left", o.left, "bus of the left hand: local:/path/socket or socketcan:INTERFACE")->required();
  run.add_option("--right", o.right, "bus of the right hand")->required();
  run.add_option("--device", o.device, "device record (TOML, see scenes/devices) of both hands; default: omni-class")
      ->check(not_empty);
  run.add_flag("--override-passivity", o.override_passivity,
               "take a coupling stiffer than the device can render stably (docs/haptics.md)");
  run.add_flag("--accept-no-drive-watchdog", o.accept_no_drive_watchdog,
               "run drives that may keep a torque if this program dies (docs/drives.md)");
  run.add_flag("--arm", o.arm, "arm at start, as the local operator; else wait for the command");
  run.add_option("--duration", o.duration_s, "end after so many seconds")->check(within(0.001, 1e6));
  run.add_option("--lcm-url", o.lcm_url, "LCM provider")->capture_default_str();
  run.add_flag("--no-telemetry", o.no_telemetry, "run without LCM: nobody sees the rig and no command reaches it");
  run.add_option_function<std::string>(
         "--rt", [&o](const std::string& mode) { o.rt = kModes.at(mode); },
         "real-time scheduling and locked memory: enforce (or exit 3), warn, off")
      ->check(CLI::IsMember({"enforce", "warn", "off"}))
      ->default_str("warn");
  run.add_option("--physics-core", o.physics_core,
                 "core of the thread's physics, its own; default: that of the loop, when the loop waits for the bus")
      ->check(within(0, 1023));
  run.add_option("--watchdog-ms", o.watchdog_ms,
                 "silence that is a fault: of a hand here, of the controller in the drives, of the loop itself")
      ->check(within(2, 10000))
      ->capture_default_str();
  run.add_option("--recorder", o.recorder,
                 "flight recorder: every tick to this file, read by 'ligature-host export'; none = off")
      ->check(not_empty)
      ->capture_default_str();
  run.add_option("--recorder-s", o.recorder_s, "seconds that it goes back, 0.7 MB each")
      ->check(within(5, 3600))
      ->capture_default_str();
  run.add_option("--wait-s", o.wait_s, "how long to wait for the hands to be there")
      ->check(within(0.0, 3600.0))
      ->capture_default_str();
  run.add_option("--scenes", o.scenes, "folder of the scenes that a command may load (default: where --scene is)")
      ->check(not_empty);
  add_budget(run, o.budget_percent);
  add_no_loss(run, o.no_loss_m_per_s);
  run.add_flag("--force", o.force, "run a scene that is not admitted (see 'admit'); the recording says so");
  run.add_flag("--exit-on-fault", o.exit_on_fault, "end the run at the first fault instead of waiting for a reset");
}

constexpr const char* kAdmitHelp =
    R"(Two questions, answered with CPU time and cold caches on the core of the loop.
Is the loop in time? Calls to the buses, control law and record must stay below the budget. The thread cannot hold the
loop up: it computes while the bus works, and the clock ends its tick.
How much of its time does the thread keep? It is laid out in its most expensive shapes (wound up, pressed together,
crumpled, held by both hands); what takes too long there, the clock ends. A loose knot is drawn tight at 0.05 to 0.4 m/s
a hand, which are surgeons' speeds, and the share of the time that the thread stood still is told. The work that contact
may take in a tick is chosen so that the dearest tick of such a knot ends by itself; a scene's suture.work_instructions
are taken as they are.
'run' does the same in short before it starts, without the knots.

Examples:
  ligature-firmware admit --scene scenes/suture-3-0.toml
  ligature-firmware admit --scene scenes/suture-3-0-square.toml --no-loss 0.25
  ligature-firmware admit --scene scenes/suture-3-0.toml --can can0 --can can1      (while no rig runs)

Exit: 0 admitted, 2 bad usage or bad scene, 3 the loop is too slow, or --no-loss is not met.)";

constexpr const char* kDoctorHelp =
    R"(One row a check, with the command that mends what is wrong; then the loop's wake-ups without its work. Run it as
the user that will run the rig, with the machine loaded as it will be; and once as root, who alone can read some
settings and start the kernel's tracers.

With --hours, --load or --report it is an acceptance test: it also sends empty frames (identifier 0x7C1) on the CAN
interfaces and times their echo. As root it looks for gaps that the machine's own firmware makes (tracer hwlat), and in
the end for what delays a wake-up (tracer timerlat, Debian's package rtla). Do it while no rig runs.

Examples:
  ligature-firmware doctor --can can0 --can can1 --seconds 10
  ligature-firmware doctor --hours 8 --load --can can0 --scene scenes/suture-3-0.toml --report monday.json
  ligature-firmware doctor --compare monday.json tuesday.json

Exit: 0 no FAIL, 2 bad usage, 3 at least one FAIL.)";

void add_can(CLI::App& command, std::vector<std::string>& can, const char* meaning) {
  command.add_option("--can", can, meaning)->allow_extra_args(false)->check([](const std::string& name) {
    const bool good = !name.empty() && name.size() < 16 &&
                      name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-") ==
                          std::string::npos &&
                      name[0] != '-';
    return good ? std::string() : "found '" + name + "', allowed the name of a network interface";
  });
}

void add_admit(CLI::App& admit, AdmitOptions& o) {
  admit.footer(kAdmitHelp);
  add_scene(admit, o.scene, o.overrides);
  add_budget(admit, o.budget_percent);
  add_no_loss(admit, o.no_loss_m_per_s);
  admit.add_option("--device", o.device, "device record (TOML) whose drives are on the buses; default: omni-class")
      ->check(not_empty);
  add_can(admit, o.can,
          "SocketCAN interface whose driver's time counts, may be given again; sends frames on it for 1 s");
  admit.add_option("--seconds", o.seconds, "how long to try")->check(within(0.1, 3600.0))->capture_default_str();
}

constexpr const char* kRehearseHelp =
    R"(What 'run' does in a process of its own with a scene that a command asks for: reads it, builds it, lets both hands
pull at it for 400 ticks and, with --no-loss, draws a knot tight in it. It gives itself 1 GB of memory and 6 s of CPU time.

Example:
  ligature-firmware rehearse --scene scenes/desk.toml

Exit: 0 it will do, 2 bad usage or bad scene, 3 the scene loses time that --no-loss forbids.)";

void add_rehearse(CLI::App& rehearse, RehearseOptions& o) {
  rehearse.footer(kRehearseHelp);
  add_scene(rehearse, o.scene, o.overrides);
  add_no_loss(rehearse, o.no_loss_m_per_s);
  rehearse.add_option("--text-from", o.text_from, "file with the scene's text, when --scene only names it")
      ->check(not_empty);
}

void add_doctor(CLI::App& doctor, DoctorOptions& o) {
  doctor.footer(kDoctorHelp);
  auto* const seconds = doctor.add_option("--seconds", o.seconds, "how long to measure wake-ups; 0 = only the table")
                            ->check(within(0.0, 86400.0))
                            ->capture_default_str();
  doctor.add_option("--hours", o.hours, "the same in hours")->check(within(1e-4, 1000.0))->excludes(seconds);
  doctor.add_flag("--load", o.load,
                  "keep memory, disk, CPU and network busy meanwhile: four processes that end by themselves");
  doctor
      .add_option("--scene", o.scene,
                  "judge wake-ups by what this scene leaves (default with --hours, --load, --report: a scene with all "
                  "default values; otherwise: 100 and 300 us)")
      ->check(not_empty);
  doctor.add_option("--report", o.report, "JSON file for everything found, with wake-ups in bins of 1 us")
      ->check(not_empty);
  doctor.add_option("--compare", o.compare, "print two reports side by side, and do nothing else")
      ->expected(2)
      ->check(not_empty);
  doctor.add_option("--device", o.device, "device record (TOML): also says what its drives cannot promise")
      ->check(not_empty);
  doctor
      .add_option("--watchdog-ms", o.watchdog_ms,
                  "the --watchdog-ms that `run` will have; what the drives of --device do depends on it")
      ->check(within(2, 10000))
      ->capture_default_str();
  add_can(doctor, o.can, "SocketCAN interface to look at, may be given again");
}

std::string one_line(std::string text) {
  for (char& c : text) c = c == '\n' ? ' ' : c;
  return text;
}

}  // namespace

std::variant<Command, Exit> parse(int argc, char** argv) {
  RunOptions run;
  AdmitOptions admit;
  RehearseOptions rehearse;
  DoctorOptions doctor;
  CLI::App app{kAbout, "ligature-firmware"};
  app.set_version_flag("--version", std::string("ligature-firmware ") + LIGATURE_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Begin with 'doctor' on a new machine and 'admit' with a new scene. 'ligature-firmware COMMAND --help' explains\n"
      "each. Exit: 0 done, 2 bad usage or input, 3 the run failed or the machine or scene does not do.");
  add_run(*app.add_subcommand("run", "run the rig"), run);
  add_admit(*app.add_subcommand("admit", "measure whether a scene's worst tick fits into the period"), admit);
  add_rehearse(*app.add_subcommand("rehearse", "try a scene as 'run' tries what commands load"), rehearse);
  add_doctor(*app.add_subcommand("doctor", "check whether this machine can hold the rate"), doctor);
  const auto refused = [](const std::string& why) {
    std::fprintf(stderr, "ligature-firmware: %s (see --help)\n", one_line(why).c_str());
    return Exit{2};
  };
  if (const auto unknown = unknown_command(app, argc, argv); !unknown.empty()) return refused(unknown);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return e.get_exit_code() == 0 ? Exit{app.exit(e)} : refused(e.what());
  }
  if (app.got_subcommand("admit")) return Command(admit);
  if (app.got_subcommand("rehearse")) return Command(rehearse);
  if (app.got_subcommand("doctor")) return Command(doctor);
  return Command(run);
}

}  // namespace ligature::app
