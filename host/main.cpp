// ligature-host: records the rig, reads recordings, names knots, sends commands.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>

#include "host/commands.hpp"
#include "host/console/likely_option.hpp"
#include "host/console/stop_signal.hpp"
#include "host/console/unknown_command.hpp"
#include "host/errors.hpp"
#include "host/stream/command.hpp"
#include "host/view/commands.hpp"

namespace {

/// Prints one line on stderr. @return `exit_code`.
int complain(const std::string& what, int exit_code) {
  std::fflush(stdout);
  std::fprintf(stderr, "ligature-host: %s\n", what.c_str());
  return exit_code;
}

constexpr const char* kUntold = "standard output cannot be written";

/// Flushes the standard output. @return whether everything was written; --help and --version print through std::cout.
bool is_told() { return std::cout.flush().good() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0; }

}  // namespace

int main(int argc, char** argv) {
  using namespace ligature::host;
  CLI::App app{"Records the haptic rig, reads its recordings, names knots and sends commands."};
  app.name("ligature-host");
  app.set_version_flag("--version", "ligature-host " LIGATURE_VERSION);
  app.require_subcommand(1);
  add_record(app);
  add_export(app);
  add_plot(app);
  add_compare(app);
  add_report(app);
  add_knot(app);
  add_send(app);
  view::add_view(app);
  view::add_replay(app);
  stream::add_stream(app);
  app.footer(
      "Example: record a run, look at it, name the knot\n"
      "  ligature-host record --out knot.lcmlog\n"
      "  ligature-host report knot.lcmlog\n"
      "  ligature-host plot knot.lcmlog --out forces.png\n"
      "  ligature-host knot knot.lcmlog\n"
      "'ligature-host COMMAND --help' explains each.\n"
      "Exit code: 0 done, 2 bad usage or bad input, 3 the work itself failed.");
  if (const auto unknown = ligature::console::unknown_command(app, argc, argv); !unknown.empty())
    return complain(unknown, 2);
  ligature::console::catch_stop_signals();
  ligature::console::outlive_closed_pipes();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error) == 0 && is_told() ? 0 : complain(kUntold, 3);
    return complain(error.what() + ligature::console::likely_option(app, argc, argv) + " (see --help)", 2);
  } catch (const BadInput& error) {
    return complain(error.what(), 2);
  } catch (const std::exception& error) {
    return complain(error.what(), 3);
  }
  return is_told() ? 0 : complain(kUntold, 3);
}
