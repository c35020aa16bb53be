// ligature-lab: runs the thread offline, with the firmware's physics library, without real time and without a CAN bus.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>

#include "host/console/likely_option.hpp"
#include "host/console/stop_signal.hpp"
#include "host/console/unknown_command.hpp"
#include "host/lab/experiment_command.hpp"
#include "host/lab/fit_command.hpp"
#include "host/lab/outcome.hpp"
#include "host/lab/pareto_command.hpp"
#include "host/lab/published/published_command.hpp"
#include "host/lab/regress/regress_command.hpp"
#include "host/lab/rerun/rerun_command.hpp"
#include "host/lab/run_command.hpp"
#include "host/lab/study_command.hpp"
#include "host/lab/tie/play_command.hpp"
#include "host/lab/tie/tie_command.hpp"
#include "host/lab/validate/proceed.hpp"
#include "host/lab/validate_command.hpp"

namespace {

constexpr const char* kAbout =
    "Plays scenes offline, with the physics that the real-time firmware runs, as fast as the machine can.\n"
    "Start with:  ligature-lab run scenes/paper.toml --grippers scenes/operators/overhand.csv --out out/overhand";

/// Prints one line on stderr; line breaks in the text are removed.
void complain(std::string text) {
  for (auto& c : text) {
    if (c == '\n') c = ' ';
  }
  std::fprintf(stderr, "ligature-lab: %s\n", text.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  using namespace ligature::lab;
  ligature::console::catch_stop_signals();
  int exit_code = kDone;
  CLI::App app(kAbout, "ligature-lab");
  app.set_version_flag("--version", "ligature-lab " LIGATURE_VERSION);
  app.require_subcommand(1);
  app.footer(
      "'ligature-lab COMMAND --help' explains each.\n"
      "Exit: 0 done; 1 a case of 'validate' misses, or a 'rerun' as recorded differs; 2 bad usage or input, nothing "
      "written;\n"
      "3 the run itself failed; 130 interrupted: what was finished before is printed and kept.");
  add_run_command(app, exit_code);
  add_experiment_commands(app, exit_code);
  add_tie_command(app, exit_code);
  add_play_command(app, exit_code);
  add_rerun_command(app, exit_code);
  add_validate_command(app, exit_code);
  add_published_command(app, exit_code);
  add_regress_command(app, exit_code);
  add_pareto_command(app, exit_code);
  add_fit_command(app, exit_code);
  add_study_command(app);
  if (const auto unknown = ligature::console::unknown_command(app, argc, argv); !unknown.empty()) {
    complain(unknown);
    return kBadInput;
  }
  try {
    app.parse(argc, argv);
  } catch (const Refusal& refusal) {
    complain(refusal.what());
    return refusal.code;
  } catch (const CLI::Success& success) {
    app.exit(success);
  } catch (const CLI::ParseError& error) {
    complain(error.what() + ligature::console::likely_option(app, argc, argv) + " (see ligature-lab --help)");
    return kBadInput;
  } catch (const ligature::validate::Interrupted& error) {
    complain(error.what());
    return kInterrupted;
  } catch (const std::exception& error) {
    complain(error.what());
    return kRunFailed;
  }
  if (!std::cout.flush() || std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    complain("standard output cannot be written");
    return kRunFailed;
  }
  return exit_code;
}
