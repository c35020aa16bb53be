// ligature-firmware: parses the command line, runs the command, returns its exit code.

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <iostream>

#include "firmware/app/admit_command.hpp"
#include "firmware/app/doctor.hpp"
#include "firmware/app/options.hpp"
#include "firmware/app/rehearsal.hpp"
#include "firmware/app/run.hpp"

namespace {

/// Exit code: 0 if everything printed to standard output was written, else 3.
int told() {
  if (std::cout.flush() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return 0;
  std::fputs("ligature-firmware: standard output cannot be written\n", stderr);
  return 3;
}

int obey(const ligature::app::RunOptions& o) { return ligature::app::run(o); }
int obey(const ligature::app::AdmitOptions& o) { return ligature::app::admit_scene(o); }
int obey(const ligature::app::RehearseOptions& o) { return ligature::app::rehearse_scene(o); }
int obey(const ligature::app::DoctorOptions& o) { return ligature::app::doctor(o); }

}  // namespace

int main(int argc, char** argv) {
  const auto parsed = ligature::app::parse(argc, argv);
  if (const auto* done = std::get_if<ligature::app::Exit>(&parsed)) return done->code == 0 ? told() : done->code;
  spdlog::set_default_logger(spdlog::stderr_color_mt("firmware"));  // stdout is for the summary table
  spdlog::set_pattern("%H:%M:%S.%e %^%l%$ %v");
  const int code = std::visit([](const auto& o) { return obey(o); }, std::get<ligature::app::Command>(parsed));
  return code == 0 ? told() : code;
}
