#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "host/commands.hpp"
#include "host/commands/options.hpp"
#include "host/plot.hpp"

namespace ligature::host {

void add_plot(CLI::App& app) {
  struct Options {
    std::string log, out;
    bool by_frame = false, thread = false;
  };
  auto* command = app.add_subcommand("plot", "Draw the force on each hand against time, or the thread and its knot");
  const auto options = std::make_shared<Options>();
  command->add_option("log", options->log, "LCM log of 'record'")->required();
  command->add_option("--out", options->out, "picture to write: .png, .svg or .pdf")->required();
  command->add_flag("--frames", options->by_frame,
                    "against the number of the haptic frame instead of time, as the paper's Table III");
  command
      ->add_flag("--thread", options->thread, "instead of forces the thread's last shape, whole and its knot magnified")
      ->excludes("--frames");
  command->footer(
      "Draws |F| per hand, the device's limit, grasp and release, and the controller's state. Spikes are never "
      "thinned\n"
      "away. Uses matplotlib of the Python set up by scripts/setup; LIGATURE_PYTHON names another one.\n\n"
      "Examples:\n  ligature-host plot knot.lcmlog --out forces.png\n"
      "  ligature-host plot knot.lcmlog --thread --out knot.png");
  command->callback([options] {
    refuse_same_file(options->log, options->out);
    if (options->thread)
      plot_thread(options->log, options->out);
    else
      plot(options->log, options->out, options->by_frame);
    std::printf("drew %s\n", options->out.c_str());
  });
}

}  // namespace ligature::host
