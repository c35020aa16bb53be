#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "host/commands.hpp"
#include "host/report.hpp"

namespace ligature::host {

void add_report(CLI::App& app) {
  struct Options {
    std::string log;
    bool json = false;
  };
  auto* command = app.add_subcommand("report", "Say how a run went: rate, deadlines, forces, losses, knot");
  const auto options = std::make_shared<Options>();
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

}  // namespace ligature::host
