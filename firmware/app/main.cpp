// ligature-firmware: options in, exit code out.

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "firmware/app/options.hpp"
#include "firmware/app/run.hpp"

int main(int argc, char** argv) {
  const auto parsed = ligature::app::parse(argc, argv);
  if (const auto* done = std::get_if<ligature::app::Exit>(&parsed)) return done->code;
  spdlog::set_default_logger(spdlog::stderr_color_mt("firmware"));  // stdout is for the final table
  spdlog::set_pattern("%H:%M:%S.%e %^%l%$ %v");
  return ligature::app::run(std::get<ligature::app::RunOptions>(parsed));
}
