// ligature-firmware: options in, exit code out.

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "firmware/app/admit_command.hpp"
#include "firmware/app/doctor.hpp"
#include "firmware/app/options.hpp"
#include "firmware/app/run.hpp"

namespace {

int obey(const ligature::app::RunOptions& o) { return ligature::app::run(o); }
int obey(const ligature::app::AdmitOptions& o) { return ligature::app::admit_scene(o); }
int obey(const ligature::app::DoctorOptions& o) { return ligature::app::doctor(o); }

}  // namespace

int main(int argc, char** argv) {
  const auto parsed = ligature::app::parse(argc, argv);
  if (const auto* done = std::get_if<ligature::app::Exit>(&parsed)) return done->code;
  spdlog::set_default_logger(spdlog::stderr_color_mt("firmware"));  // stdout is for the final table
  spdlog::set_pattern("%H:%M:%S.%e %^%l%$ %v");
  return std::visit([](const auto& options) { return obey(options); }, std::get<ligature::app::Command>(parsed));
}
