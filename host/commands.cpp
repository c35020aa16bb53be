#include "host/commands.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <optional>

#include "host/csv_tables.hpp"
#include "host/errors.hpp"
#include "host/export.hpp"
#include "host/knot_command.hpp"
#include "host/plot.hpp"
#include "host/record.hpp"
#include "host/report.hpp"
#include "host/send.hpp"

namespace ligature::host {
namespace {

/// Options of one subcommand, kept as long as the parser.
template <class Options>
std::shared_ptr<Options> kept(CLI::App&) {
  return std::make_shared<Options>();
}

void refuse_same_file(const std::string& log, const std::string& target) {
  std::error_code none;
  if (!target.empty() && std::filesystem::equivalent(log, target, none))
    throw BadInput(target + ": is the log itself; allowed: another name");
}

/// CLI11's ranges let nan pass: no comparison with it is true.
std::string finite(const std::string& word) {
  double value = 0.0;
  if (CLI::detail::lexical_cast(word, value) && !std::isfinite(value))
    return "found '" + word + "', allowed a finite number";
  return {};
}

void add_url(CLI::App& command, std::string& url) {
  command.add_option("--lcm-url", url, "LCM network; ttl=0 keeps every packet on this machine")->capture_default_str();
}

}  // namespace

void add_record(CLI::App& app) {
  auto* command = app.add_subcommand("record", "Record every message of the rig into an LCM log");
  const auto options = kept<RecordOptions>(app);
  command->add_option("--out", options->out, "log to write (lcm-logplayer plays it)")->required();
  add_url(*command, options->lcm_url);
  command->add_option("--duration", options->duration_s, "seconds; without it until Ctrl-C or SIGTERM")
      ->check(finite)
      ->check(CLI::Range(0.001, 1e7));
  command->add_flag("--force", options->force, "replace an existing file");
  command->add_flag("--quiet", options->quiet, "no progress");
  command->footer(
      "Counts every tick while it writes and names those that never came. It does not end when the firmware does: a\n"
      "restarted firmware becomes a further session of the same log. A killed recorder leaves all it had received.\n"
      "What the network loses is fetched from the firmware's flight recorder when that is on this machine.\n"
      "Exit code 3 when the disk refuses, the network cannot be opened, or nothing at all came.\n\n"
      "Example:\n  ligature-host record --out knot.lcmlog --duration 25\n"
      "  recorded 25000 of 25000 ticks, 0 lost; 1500 shapes, 3017 messages in all");
  command->callback([options] { record(*options); });
}

void add_export(CLI::App& app) {
  struct Options {
    std::string log;
    ExportTargets targets;
  };
  auto* command = app.add_subcommand("export", "Write a log as CSV, HDF5 or MCAP");
  const auto options = kept<Options>(app);
  command->add_option("log", options->log, "LCM log of 'record', or a flight recorder file")->required();
  command->add_option("--forces", options->targets.csv.forces, "CSV: forces, grasp and state of every tick");
  command->add_option("--shape", options->targets.csv.shape, "CSV: the thread's nodes at 60 Hz");
  command->add_option("--ticks", options->targets.csv.ticks, "CSV: every field of every tick");
  command->add_option("--hdf5", options->targets.hdf5, "HDF5: everything in one file (docs/analysis.md)");
  command->add_option("--mcap", options->targets.mcap, "MCAP: for Foxglove, PlotJuggler and other viewers");
  command->footer(forces_columns_help() + shape_columns_help() + ticks_columns_help() +
                  "Units are SI. Every file carries what its columns mean, the scene's text and the versions.\n"
                  "The log may also be a flight recorder file of the firmware, or one that it saved with a fault: it "
                  "has ticks and\n"
                  "no shapes. Each tick once, in order; missing ones are named. A cut-off log is exported up to its "
                  "last whole event, and that is\n"
                  "said. Files appear complete or not at all.\n\n"
                  "Example:\n  ligature-host export knot.lcmlog --forces forces.csv --hdf5 knot.h5");
  command->callback([options] {
    const auto& [csv, hdf5, mcap] = options->targets;
    const std::initializer_list<std::string> targets{csv.forces, csv.shape, csv.ticks, hdf5, mcap};
    if (std::ranges::all_of(targets, [](const auto& t) { return t.empty(); }))
      throw BadInput(
          "export: found nothing to write, allowed one or more of --forces, --shape, --ticks, --hdf5, --mcap");
    for (const auto& target : targets) refuse_same_file(options->log, target);
    const auto result = export_recording(options->log, options->targets);
    if (!result.damage.empty())
      std::fprintf(stderr, "ligature-host: %s: %s\n", options->log.c_str(), result.damage.c_str());
    std::printf("exported %lld ticks and %lld shapes", static_cast<long long>(result.tick_rows),
                static_cast<long long>(result.shapes));
    if (result.duplicates_left_out)
      std::printf(", left out %lld duplicates", static_cast<long long>(result.duplicates_left_out));
    if (result.unreadable_messages)
      std::printf(", %lld unreadable messages", static_cast<long long>(result.unreadable_messages));
    if (result.missing)
      std::printf("; %lld ticks are missing: %s", static_cast<long long>(result.missing), result.missing_ticks.c_str());
    std::printf("\n");
  });
}

void add_plot(CLI::App& app) {
  struct Options {
    std::string log, out;
    bool by_frame = false;
  };
  auto* command = app.add_subcommand("plot", "Draw the force on each hand against time");
  const auto options = kept<Options>(app);
  command->add_option("log", options->log, "LCM log of 'record'")->required();
  command->add_option("--out", options->out, "picture to write: .png, .svg or .pdf")->required();
  command->add_flag("--frames", options->by_frame,
                    "against the number of the haptic frame instead of time, as the paper's Table III");
  command->footer(
      "Draws |F| per hand, the device's limit, grasp and release, and the controller's state. Spikes are never "
      "thinned\n"
      "away. Uses matplotlib of the Python set up by scripts/setup; LIGATURE_PYTHON names another one.\n\n"
      "Example:\n  ligature-host plot knot.lcmlog --out forces.png");
  command->callback([options] {
    refuse_same_file(options->log, options->out);
    plot(options->log, options->out, options->by_frame);
    std::printf("drew %s\n", options->out.c_str());
  });
}

void add_compare(CLI::App& app) {
  struct Options {
    std::string log_a, log_b, out, align = "start";
    double shift_s = 0.0;
  };
  auto* command = app.add_subcommand("compare", "Draw the forces of two logs over each other and say what differs");
  const auto options = kept<Options>(app);
  command->add_option("a", options->log_a, "LCM log of 'record', or a flight recorder file")->required();
  command->add_option("b", options->log_b, "another one")->required();
  command->add_option("--out", options->out, "picture to write: .png, .svg or .pdf")->required();
  command->add_option("--align", options->align, "what of both is time 0: their first tick, or their first grasp")
      ->check(CLI::IsMember({"start", "grasp"}))
      ->capture_default_str();
  command->add_option("--shift", options->shift_s, "b later by so many seconds")->check(finite)->capture_default_str();
  command->footer(
      "|F| of each hand in both, and b minus a below. Prints peak, mean while holding and root mean square of the\n"
      "difference where both have a tick. For one drawing of one log: plot.\n\n"
      "Example:\n  ligature-host compare monday.lcmlog tuesday.lcmlog --align grasp --out both.png");
  command->callback([options] {
    for (const auto& log : {options->log_a, options->log_b}) refuse_same_file(log, options->out);
    plot_comparison(options->log_a, options->log_b, options->out, options->align, options->shift_s);
    std::printf("drew %s\n", options->out.c_str());
  });
}

void add_report(CLI::App& app) {
  struct Options {
    std::string log;
    bool json = false;
  };
  auto* command = app.add_subcommand("report", "Say how a run went: rate, deadlines, forces, losses, knot");
  const auto options = kept<Options>(app);
  command->add_option("log", options->log, "LCM log of 'record'")->required();
  command->add_flag("--json", options->json, "as one JSON object");
  command->footer(
      "Percentiles are nearest-rank over all executed ticks. Mean force is over the ticks with a grasp. The knot is "
      "named\n"
      "ten times a second of the recording.\n\n"
      "Example:\n  ligature-host report knot.lcmlog --json | jq .execution_us.p99");
  command->callback([options] {
    const LogSummary summary = summarise(options->log);
    std::fputs((options->json ? report_json(summary) : report_table(summary)).c_str(), stdout);
  });
}

void add_knot(CLI::App& app) {
  auto* command = app.add_subcommand("knot", "Name the knot of a polyline or of a recorded thread");
  const auto options = kept<KnotOptions>(app);
  command->add_option("file", options->file, "CSV with columns x,y,z (or x_m,y_m,z_m), a shape.csv, or an LCM log")
      ->required();
  auto* closed = command->add_flag("--closed", options->closed, "the last point joins the first");
  command->add_flag("--open", options->open, "it does not")->excludes(closed);
  command->add_option("--at", options->at_s, "time of the shape, s: the nearest one (default: the last one)")
      ->check(finite);
  command->add_flag("--json", options->json, "as one JSON line");
  command->footer(
      "Without --closed and --open a polyline is closed when its last point repeats its first. A knot that cannot be\n"
      "named is 'unknown', with its invariants. Alexander coefficients stand from the lowest power.\n\n"
      "Right is the trefoil whose crossings count +3, the one that scripts/demo ties.\n\n"
      "Example:\n  ligature-host knot knot.lcmlog --json\n"
      "  {\"type\":\"3_1\",\"handedness\":\"right\",\"determinant\":3,\"alexander\":[1,-1,1]}");
  command->callback([options] { std::fputs(describe_knot(*options).c_str(), stdout); });
}

void add_send(CLI::App& app) {
  struct Options {
    std::string word, text, lcm_url{kDefaultLcmUrl};
    std::optional<double> value;
  };
  auto* command = app.add_subcommand("send", "Send the firmware a command and print its answer");
  const auto options = kept<Options>(app);
  command->add_option("command", options->word, "arm, disarm, stop, reset-fault, reset-thread, load-scene or set")
      ->required()
      ->check(CLI::IsMember({"arm", "disarm", "stop", "reset-fault", "reset-thread", "load-scene", "set"}));
  command->add_option("name", options->text, "load-scene: the scene file's name; set: the parameter's key");
  command->add_option("value", options->value, "set: the parameter's value")->check(finite);
  add_url(*command, options->lcm_url);
  command->footer(
      "load-scene takes a file of the firmware's --scenes folder, in OFF and IDLE only, where no force can flow. set "
      "changes\n"
      "a parameter within its range, at any time. What may be asked for is in the refusal of what may not. Both are "
      "built and\n"
      "measured beside the running loop first, and refused when the worst tick would not fit.\n"
      "Waits up to 1 s (load-scene, set: 10 s); exit code 3 when the firmware refuses or does not answer. No command "
      "can by itself put force "
      "on\n"
      "a hand: that needs the dead-man button of the device as well.\n\n"
      "Example:\n  ligature-host send stop\n  ligature-host send load-scene desk.toml\n"
      "  ligature-host send set contact.friction 0.5");
  command->callback([options] {
    const bool is_scene = options->word == "load-scene", is_set = options->word == "set";
    const bool has_text = !options->text.empty(), has_value = options->value.has_value();
    if (has_text != (is_scene || is_set) || has_value != is_set)
      throw BadInput("send " + options->word + ": found " + std::to_string(has_text + has_value) +
                     " further words, allowed " +
                     (is_set     ? "a key and a value"
                      : is_scene ? "the name of a scene"
                                 : "none"));
    send(options->word, options->text, options->value.value_or(0.0), options->lcm_url);
  });
}

}  // namespace ligature::host
