#include <CLI/CLI.hpp>
#include <memory>

#include "host/commands.hpp"
#include "host/commands/options.hpp"
#include "host/record.hpp"

namespace ligature::host {

void add_record(CLI::App& app) {
  auto* command = app.add_subcommand("record", "Record every message of the rig into an LCM log");
  const auto options = std::make_shared<RecordOptions>();
  command->add_option("--out", options->out, "log to write (ligature-host replay shows it)")->required();
  add_url(*command, options->lcm_url);
  command->add_option("--duration", options->duration_s, "seconds; without it until Ctrl-C or SIGTERM")
      ->check(finite)
      ->check(CLI::Range(0.001, 1e7));
  command
      ->add_option("--flight-folder", options->flight_folders,
                   "folder whose flight recorders fill gaps; default: where ligature-firmware and its service put it")
      ->check(CLI::ExistingDirectory);
  command->add_flag("--force", options->force, "replace an existing file, which stays until a message comes");
  command->add_flag("--quiet", options->quiet, "no progress");
  command->footer(
      "Counts every tick while it writes and names those that never came. It does not end when the firmware does: a\n"
      "restarted firmware becomes a further session of the same log. A killed recorder leaves all it had received.\n"
      "What the network loses, the last ticks of a killed firmware among it, is fetched from the flight recorder when "
      "that is\n"
      "on this machine, in the folder where it is put or in a --flight-folder. 'At least .. ticks' is said when nobody "
      "can tell\n"
      "how many there were.\n"
      "Exit code 3 when the disk refuses, the network cannot be opened, or nothing at all came.\n\n"
      "Example:\n  ligature-host record --out knot.lcmlog --duration 25\n"
      "  recorded 25000 of 25000 ticks, 0 lost; 1500 shapes, 3017 messages in all");
  command->callback([options] { record(*options); });
}

}  // namespace ligature::host
