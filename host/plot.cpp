#include "host/plot.hpp"

#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <vector>

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
  throw BadInput("plot: no Python at " + python + "; remedy: run scripts/setup, or set LIGATURE_PYTHON to one that has "
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

/// Runs a program without a shell and waits for it. @return its exit code, 128 + n when signal n ended it.
int run(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  if (const int error = posix_spawn(&child, arguments[0], nullptr, nullptr, arguments.data(), environ); error != 0)
    throw RunFailed("plot: cannot start " + words[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

void plot(const std::string& log_path, const std::string& out_path) {
  const std::string python = find_python(), script = find_script();
  const RigFacts facts = read_rig_facts(log_path);
  const ScratchFolder scratch;
  const std::string forces_csv = scratch.file("forces.csv");
  const auto exported = export_csv(log_path, {.forces = forces_csv, .shape = {}, .ticks = {}});
  if (!exported.damage.empty()) std::fprintf(stderr, "ligature-host: %s: %s\n", log_path.c_str(), exported.damage.c_str());
  const std::string title = facts.scene_file.empty() ? fs::path(log_path).filename().string()
                                                     : fs::path(facts.scene_file).filename().string();
  const int code = run({python, script, forces_csv, "--out", out_path, "--title", title, "--limit",
                        text("%.17g", facts.max_force_N)});
  if (code != 0)
    throw RunFailed("plot: " + python + " " + script + " ended with " + std::to_string(code) +
                    "; remedy for a missing package: scripts/setup");
}

}  // namespace ligature::host
