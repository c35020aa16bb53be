#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "host/commands.hpp"
#include "host/commands/options.hpp"
#include "host/knot_command.hpp"

namespace ligature::host {

void add_knot(CLI::App& app) {
  auto* command = app.add_subcommand("knot", "Name the knot of a polyline or of a recorded thread");
  const auto options = std::make_shared<KnotOptions>();
  command
      ->add_option("file", options->file,
                   "columns x,y,z (or x_m,y_m,z_m), by name or in this order, parted by commas, semicolons or blanks; "
                   "a shape.csv; or an LCM log")
      ->required();
  auto* closed = command->add_flag("--closed", options->closed, "the last point joins the first");
  command->add_flag("--open", options->open, "it does not")->excludes(closed);
  command->add_option("--at", options->at_s, "time of the shape, s: the nearest one (default: the last one)")
      ->check(finite);
  command->add_flag("--json", options->json, "as one JSON line");
  command->footer(
      "Without --closed and --open a polyline is closed when its last point repeats its first. A knot that cannot be\n"
      "named is 'unknown', with its invariants. Alexander coefficients stand from the lowest power.\n\n"
      "Right is the trefoil whose crossings count +3, the one that scripts/demo ties; of any other knot the hand "
      "whose\n"
      "reduced alternating diagram counts above 0 (tables that go by Rolfsen's drawings may have 7_7 the other "
      "way).\n\n"
      "Example:\n  ligature-host knot knot.lcmlog --json\n"
      "  {\"type\":\"3_1\",\"handedness\":\"right\",\"determinant\":3,\"alexander\":[1,-1,1]}");
  command->callback([options] { std::fputs(describe_knot(*options).c_str(), stdout); });
}

}  // namespace ligature::host
