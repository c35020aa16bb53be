#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "host/commands.hpp"
#include "host/commands/options.hpp"
#include "host/plot.hpp"

namespace ligature::host {

void add_plot(CLI::App& app) {
  struct Options {
    std::string log, out;
    bool by_frame = false, thread = false, latency = false;
    std::vector<std::string> beside;
  };
  auto* command = app.add_subcommand("plot", "Draw the force on each hand against time, or the thread and its knot");
  const auto options = std::make_shared<Options>();
  command->add_option("log", options->log, "LCM log of 'record'; with --latency a report of 'ligature-firmware doctor'")
      ->required();
  command->add_option("--out", options->out, "picture to write: .png, .svg or .pdf")->required();
  command->add_flag("--frames", options->by_frame,
                    "against the number of the haptic frame instead of time, as the paper's Table III");
  command
      ->add_flag("--thread", options->thread, "instead of forces the thread's last shape, whole and its knot magnified")
      ->excludes("--frames");
  auto* const latency =
      command
          ->add_flag("--latency", options->latency, "the wake-up latencies of a report of 'ligature-firmware doctor'")
          ->excludes("--frames")
          ->excludes("--thread");
  command->add_option("--beside", options->beside, "further reports to draw in the same picture")->needs(latency);
  command->footer(
      "Draws |F| per hand, the device's limit, grasp and release, and the controller's state. Spikes are never "
      "thinned\n"
      "away. Uses matplotlib of the Python set up by scripts/setup; LIGATURE_PYTHON names another one.\n\n"
      "Examples:\n  ligature-host plot knot.lcmlog --out forces.png\n"
      "  ligature-host plot knot.lcmlog --thread --out knot.png\n"
      "  ligature-host plot monday.json --latency --beside tuesday.json --out latency.png");
  command->callback([options] {
    refuse_same_file(options->log, options->out);
    for (const auto& report : options->beside) refuse_same_file(report, options->out);
    if (options->latency) {
      options->beside.insert(options->beside.begin(), options->log);
      plot_latency(options->beside, options->out);
    } else if (options->thread) {
      plot_thread(options->log, options->out);
    } else {
      plot(options->log, options->out, options->by_frame);
    }
    std::printf("drew %s\n", options->out.c_str());
  });
}

}  // namespace ligature::host
