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
                   "columns x,y,z (or x_m,y_m,z_m) by name, parted by commas, semicolons or blanks; without a header "
                   "three columns are x,y,z, and four are row number,x,y,z; a shape.csv; or an LCM log")
      ->required();
  auto* closed = command->add_flag("--closed", options->closed, "the last point joins the first");
  command->add_flag("--open", options->open, "it does not")->excludes(closed);
  command
      ->add_option("--at", options->at_s,
                   "time of the shape, s: the nearest one, at most 1 s away (default: the last one)")
      ->check(finite);
  command->add_flag("--json", options->json, "as one JSON line");
  command->footer(
      "Without --closed and --open a polyline is closed when its last point repeats its first. Named are the prime\n"
      "knots to eight crossings and their sums to ten. Any other knot is 'unknown', with its invariants, and, when a\n"
      "diagram of at most ten crossings was found, with its candidates: it is one of them. Alexander coefficients\n"
      "stand from the lowest power.\n\n"
      "Right is the trefoil whose crossings count +3, the one that scripts/demo ties; of any other knot the hand "
      "whose\n"
      "reduced alternating diagram counts above 0; where none does (8_4, 8_19 to 8_21), the hand in whose Jones\n"
      "polynomial lowest and highest exponent have a positive sum. Tables that go by Rolfsen's drawings may differ "
      "(7_7).\n\n"
      "Example:\n  ligature-host knot knot.lcmlog --json\n"
      "  {\"type\":\"3_1\",\"handedness\":\"right\",\"determinant\":3,\"alexander\":[1,-1,1],"
      "\"common_name\":\"overhand\",\"candidates\":[]}");
  command->callback([options] { std::fputs(describe_knot(*options).c_str(), stdout); });
}

}  // namespace ligature::host
