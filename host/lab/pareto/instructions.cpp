#include "host/lab/pareto/instructions.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

extern char** environ;

namespace ligature::lab {
namespace {

namespace fs = std::filesystem;

/// Runs valgrind with its output discarded. @return whether it succeeded.
bool run_quietly(std::vector<std::string> words) {
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (auto& w : words) argv.push_back(w.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  for (const int fd : {STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&files, fd, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  int status = -1;
  if (posix_spawnp(&child, argv[0], &files, nullptr, argv.data(), environ) == 0) waitpid(child, &status, 0);
  posix_spawn_file_actions_destroy(&files);
  return status == 0;
}

/// The instruction count in a callgrind dump: its line "totals: N".
std::optional<double> total_of(const fs::path& file) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("totals:")) return std::stod(line.substr(7));
  }
  return std::nullopt;
}

}  // namespace

std::optional<Spread> count_instructions(const Setting& setting, int ticks) {
  char name[] = "/tmp/ligature-pareto-XXXXXX";
  if (mkdtemp(name) == nullptr) return std::nullopt;
  const fs::path folder(name);
  std::error_code none;
  const auto self = fs::read_symlink("/proc/self/exe", none).string();
  // Two patterns that match the same function: two callgrind options use them, and callgrind keeps only one option per
  // pattern
  const std::string tick = "ligature::lab::measured_tick*", same_tick = "*measured_tick*";
  const bool ran = run_quietly({"valgrind", "--tool=callgrind", "--toggle-collect=" + tick, "--dump-after=" + same_tick,
                                "--callgrind-out-file=" + (folder / "out").string(), self, "pareto", "--one",
                                setting.text(), "--ticks", std::to_string(ticks)});
  std::vector<double> counts;
  if (ran) {
    for (const auto& file : fs::directory_iterator(folder, none)) {
      const auto count = total_of(file.path());
      if (count && *count > 0.0) counts.push_back(*count);
    }
  }
  fs::remove_all(folder, none);
  if (counts.size() < 10) return std::nullopt;
  return spread_of(std::move(counts));
}

}  // namespace ligature::lab
