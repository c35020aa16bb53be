#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "host/commands.hpp"
#include "host/commands/options.hpp"
#include "host/csv_tables.hpp"
#include "host/damage_notice.hpp"
#include "host/errors.hpp"
#include "host/export.hpp"

namespace ligature::host {
namespace {

void refuse_twins(std::initializer_list<std::string> targets) {
  std::set<std::filesystem::path> seen;
  for (const auto& target : targets)
    if (!target.empty() && !seen.insert(std::filesystem::absolute(target).lexically_normal()).second)
      throw BadInput("export: found '" + target + "' for two tables, allowed a file of its own for each");
}

void take_span(const std::vector<double>& span_s, TraceTarget& trace) {
  if (span_s.empty()) return;
  if (trace.path.empty()) throw BadInput("export: found --trace-span without --trace, allowed with it");
  if (!(span_s[0] < span_s[1]))
    throw BadInput("export: --trace-span: found an end before the start, allowed FROM < TO");
  trace.from_s = span_s[0];
  trace.to_s = span_s[1];
}

}  // namespace

void add_export(CLI::App& app) {
  struct Options {
    std::string log;
    ExportTargets targets;
    std::vector<double> span_s;
  };
  auto* command = app.add_subcommand("export", "Write a log as CSV, HDF5, MCAP or a trace");
  const auto options = std::make_shared<Options>();
  command->add_option("log", options->log, "LCM log of 'record', or a flight recorder file")->required();
  command->add_option("--forces", options->targets.csv.forces, "CSV: forces, grasp and state of every tick");
  command->add_option("--shape", options->targets.csv.shape, "CSV: the thread's nodes at 60 Hz");
  command->add_option("--ticks", options->targets.csv.ticks, "CSV: every field of every tick");
  command->add_option("--hdf5", options->targets.hdf5, "HDF5: everything in one file (docs/analysis.md)");
  command->add_option("--mcap", options->targets.mcap, "MCAP: for Foxglove, PlotJuggler and other viewers");
  command->add_option("--trace", options->targets.trace.path,
                      "JSON trace for ui.perfetto.dev: when each phase of each tick ran (docs/analysis.md)");
  command
      ->add_option("--trace-span", options->span_s,
                   "FROM TO: only these seconds of each run in the trace; whole runs of "
                   "more than some minutes are too much for the viewer")
      ->expected(2)
      ->check(finite);
  command->footer(forces_columns_help() + shape_columns_help() + ticks_columns_help() +
                  "Units are SI. Every file carries what its columns mean, the scene's text and the versions.\n"
                  "The log may also be a flight recorder file of the firmware, or one that it saved with a fault: it "
                  "has ticks and\n"
                  "no shapes. Each tick once, in order; missing ones are named. A cut-off log is exported up to its "
                  "last whole event, and that is\n"
                  "said. Files appear complete or not at all.\n\n"
                  "Example:\n  ligature-host export knot.lcmlog --forces forces.csv --hdf5 knot.h5");
  command->callback([options] {
    take_span(options->span_s, options->targets.trace);
    const auto& [csv, hdf5, mcap, trace] = options->targets;
    const std::initializer_list<std::string> targets{csv.forces, csv.shape, csv.ticks, hdf5, mcap, trace.path};
    if (std::ranges::all_of(targets, [](const auto& t) { return t.empty(); }))
      throw BadInput(
          "export: found nothing to write, allowed one or more of --forces, --shape, --ticks, --hdf5, --mcap, "
          "--trace");
    for (const auto& target : targets) refuse_same_file(options->log, target);
    refuse_twins(targets);
    const auto result = export_recording(options->log, options->targets);
    tell_damage(options->log, result.damage);
    std::printf("exported %lld ticks and %lld shapes", static_cast<long long>(result.tick_rows),
                static_cast<long long>(result.shapes));
    if (result.duplicates_left_out)
      std::printf(", left out %lld duplicates", static_cast<long long>(result.duplicates_left_out));
    if (result.unreadable_messages)
      std::printf(", %lld unreadable messages", static_cast<long long>(result.unreadable_messages));
    if (result.left_out) std::printf(", %lld ticks of further sessions", static_cast<long long>(result.left_out));
    if (result.missing)
      std::printf("; %lld ticks are missing: %s", static_cast<long long>(result.missing), result.missing_ticks.c_str());
    std::printf("\n");
  });
}

}  // namespace ligature::host
