#include "host/console/python_tool.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "host/console/stop_signal.hpp"
#include "host/errors.hpp"

namespace ligature::console {
namespace {

namespace fs = std::filesystem;
constexpr int kBadInput = 2;  // exit code of a script whose input file is wrong

std::string find_script(const std::string& name, const fs::path& source_folder) {
  std::error_code none;
  const fs::path installed =
      fs::read_symlink("/proc/self/exe", none).parent_path().parent_path() / "share/ligature/plots" / name;
  if (fs::exists(installed, none)) return installed.string();
  const fs::path source = source_folder / name;
  if (fs::exists(source, none)) return source.string();
  throw host::RunFailed(name + " found neither at " + installed.string() + " nor in " + source_folder.string());
}

/// Waits for the child process. When this process is asked to stop, it sends SIGINT to the child, and Python then
/// removes its unfinished output file.
int status_of(pid_t child) {
  constexpr int kLook_ms = 20;
  // What it stays if waitpid() fails, as where the parent of this process ignored SIGCHLD: exit code 127, a failure.
  int status = 127 << 8;
  bool is_told = false;
  for (;;) {
    const pid_t ended = waitpid(child, &status, WNOHANG);
    if (ended == child) return status;
    if (ended < 0 && errno != EINTR) return status;
    if (stop_requested() && !is_told) is_told = kill(child, SIGINT) == 0;
    poll(nullptr, 0, kLook_ms);
  }
}

/// Runs the program and waits for it, its stderr written to the file `complaints`. @return its exit code, or 128 + n
/// when signal n ended it.
int wait_for(std::vector<std::string> words, const std::string& complaints) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t redirect;
  posix_spawn_file_actions_init(&redirect);
  posix_spawn_file_actions_addopen(&redirect, STDERR_FILENO, complaints.c_str(), O_WRONLY | O_CREAT, 0600);
  pid_t child = 0;
  const int error = posix_spawn(&child, arguments[0], &redirect, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&redirect);
  if (error != 0) throw host::RunFailed("cannot start " + words[0] + ": " + std::strerror(error));
  const int status = status_of(child);
  if (stop_requested()) throw host::RunFailed("stopped by a signal; what was not complete is not there");
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// The last non-empty line of a file: where Python's traceback gives the error.
std::string last_line(const std::string& path) {
  std::ifstream file(path);
  std::string last = "no reason given";
  for (std::string line; std::getline(file, line);)
    if (!line.empty()) last = line;
  return last;
}

}  // namespace

std::string find_python() {
  const char* chosen = getenv("LIGATURE_PYTHON");
  std::string python = chosen && *chosen ? chosen : LIGATURE_DEFAULT_PYTHON;
  if (access(python.c_str(), X_OK) == 0) return python;
  throw host::BadInput("no Python at " + python +
                       "; remedy: run scripts/setup, or set LIGATURE_PYTHON to one that has the packages of "
                       "requirements.txt");
}

ScratchFolder::ScratchFolder() {
  std::string name = (fs::temp_directory_path() / "ligature-XXXXXX").string();
  if (!mkdtemp(name.data())) throw host::RunFailed(name + ": cannot make a scratch folder");
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

PythonTool::PythonTool(const std::string& script, const fs::path& source_folder)
    : python_(find_python()), script_(find_script(script, source_folder)) {}

void PythonTool::run(const std::vector<std::string>& arguments, const std::string& complaints) const {
  std::vector<std::string> words{python_, script_};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const int code = wait_for(words, complaints);
  if (code == kBadInput) throw host::BadInput(last_line(complaints));
  if (code != 0)
    throw host::RunFailed(fs::path(script_).filename().string() + ": " + python_ + " ended with " +
                          std::to_string(code) + ": " + last_line(complaints) +
                          "; remedy for a missing package: scripts/setup");
}

}  // namespace ligature::console
