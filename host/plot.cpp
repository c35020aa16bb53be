#include "host/plot.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include "host/atomic_file.hpp"
#include "host/errors.hpp"
#include "host/export_csv.hpp"
#include "host/rig_facts.hpp"
#include "host/text.hpp"

namespace ligature::host {
namespace {

namespace fs = std::filesystem;

/// A folder that is gone when this is.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (fs::temp_directory_path() / "ligature-plot-XXXXXX").string();
    if (!mkdtemp(name.data())) throw RunFailed(name + ": cannot make a scratch folder");
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] std::string file(const char* name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

std::string find_python() {
  const char* chosen = getenv("LIGATURE_PYTHON");
  const std::string python = chosen && *chosen ? chosen : LIGATURE_DEFAULT_PYTHON;
  if (access(python.c_str(), X_OK) == 0) return python;
  throw BadInput("plot: no Python at " + python +
                 "; remedy: run scripts/setup, or set LIGATURE_PYTHON to one that has "
                 "the packages of requirements.txt");
}

/// Beside an installed program, else in the source tree it was built from.
std::string find_script() {
  std::error_code none;
  const fs::path installed =
      fs::read_symlink("/proc/self/exe", none).parent_path().parent_path() / "share/ligature/plots/plot_forces.py";
  if (fs::exists(installed, none)) return installed.string();
  if (fs::exists(LIGATURE_PLOTS_DIR "/plot_forces.py", none)) return LIGATURE_PLOTS_DIR "/plot_forces.py";
  throw RunFailed("plot: plot_forces.py found neither at " + installed.string() + " nor in " LIGATURE_PLOTS_DIR);
}

/// Runs a program without a shell, its stderr into a file, and waits for it.
/// @return its exit code, 128 + n when signal n ended it.
int run(std::vector<std::string> words, const std::string& complaints) {
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t redirect;
  posix_spawn_file_actions_init(&redirect);
  posix_spawn_file_actions_addopen(&redirect, STDERR_FILENO, complaints.c_str(), O_WRONLY | O_CREAT, 0600);
  pid_t child = 0;
  const int error = posix_spawn(&child, arguments[0], &redirect, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&redirect);
  if (error != 0) throw RunFailed("plot: cannot start " + words[0] + ": " + std::strerror(error));
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// The last line of a text: where Python says what went wrong.
std::string last_line(const std::string& path) {
  std::ifstream file(path);
  std::string last = "no reason given";
  for (std::string line; std::getline(file, line);)
    if (!line.empty()) last = line;
  return last;
}

/// @return where the picture goes, links followed.
std::string checked_target(const std::string& out_path) {
  const auto ending = fs::path(out_path).extension();
  if (ending != ".png" && ending != ".svg" && ending != ".pdf")
    throw BadInput(out_path + ": found ending '" + ending.string() + "', allowed .png, .svg or .pdf");
  return AtomicFile(out_path).path();  // made and gone again: it can be made
}

}  // namespace

void plot(const std::string& log_path, const std::string& out_path) {
  const std::string target = checked_target(out_path);
  const std::string python = find_python(), script = find_script();
  const RigFacts facts = read_rig_facts(log_path);
  const ScratchFolder scratch;
  const std::string forces_csv = scratch.file("forces.csv");
  const auto exported = export_csv(log_path, {.forces = forces_csv, .shape = {}, .ticks = {}});
  if (!exported.damage.empty())
    std::fprintf(stderr, "ligature-host: %s: %s\n", log_path.c_str(), exported.damage.c_str());
  const std::string title = facts.scene_file.empty() ? fs::path(log_path).filename().string()
                                                     : fs::path(facts.scene_file).filename().string();
  const int code =
      run({python, script, forces_csv, "--out", target, "--title", title, "--limit", text("%.17g", facts.max_force_N)},
          scratch.file("complaints"));
  if (code != 0)
    throw RunFailed("plot: " + python + " ended with " + std::to_string(code) + ": " +
                    last_line(scratch.file("complaints")) + "; remedy for a missing package: scripts/setup");
}

}  // namespace ligature::host
