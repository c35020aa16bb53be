#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <system_error>

#include "host/lab/report.hpp"

extern char** environ;

namespace ligature::lab {
namespace {

namespace fs = std::filesystem;

/// $LIGATURE_PYTHON, else the one that scripts/setup makes; empty when it cannot be run.
std::string python() {
  const char* chosen = std::getenv("LIGATURE_PYTHON");
  const std::string path = chosen && *chosen ? chosen : LIGATURE_DEFAULT_PYTHON;
  return access(path.c_str(), X_OK) == 0 ? path : std::string();
}

/// Beside an installed program, else in the source tree it was built from.
fs::path script_path(const std::string& name) {
  std::error_code none;
  const auto installed =
      fs::read_symlink("/proc/self/exe", none).parent_path().parent_path() / "share/ligature/plots" / name;
  return fs::exists(installed, none) ? installed : fs::path(LIGATURE_LAB_PLOTS_DIR) / name;
}

}  // namespace

void draw(const std::string& script, const std::vector<fs::path>& data, const fs::path& picture) {
  const auto program = python();
  if (program.empty()) {
    std::printf(
        "no picture %s: no Python with matplotlib (run scripts/setup, or set LIGATURE_PYTHON); the table is there\n",
        picture.c_str());
    return;
  }
  std::vector<std::string> words{program, script_path(script).string()};
  for (const auto& file : data) words.push_back(file.string());
  words.push_back(picture.string());
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (auto& w : words) argv.push_back(w.data());
  argv.push_back(nullptr);
  pid_t child = 0;
  int status = -1;
  if (posix_spawn(&child, program.c_str(), nullptr, nullptr, argv.data(), environ) == 0) waitpid(child, &status, 0);
  if (status == 0)
    std::printf("picture %s\n", picture.c_str());
  else
    std::printf("no picture %s: %s failed; the table is there\n", picture.c_str(), script.c_str());
}

}  // namespace ligature::lab
