#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "host/commands.hpp"
#include "host/commands/options.hpp"
#include "host/plot.hpp"

namespace ligature::host {

void add_compare(CLI::App& app) {
  struct Options {
    std::string log_a, log_b, out, align = "start";
    double shift_s = 0.0;
  };
  auto* command = app.add_subcommand("compare", "Draw the forces of two logs over each other and say what differs");
  const auto options = std::make_shared<Options>();
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

}  // namespace ligature::host
