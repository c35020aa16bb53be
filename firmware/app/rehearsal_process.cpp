#include "firmware/app/rehearsal_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <optional>

namespace ligature::app {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t kMostWords = 4096;

/// Owns a file descriptor.
class File {
 public:
  explicit File(int fd = -1) : fd_(fd) {}
  ~File() { close(); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  void close() {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
  }
  [[nodiscard]] int fd() const { return fd_; }

 private:
  int fd_;
};

bool write_all(int fd, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const auto n = ::write(fd, text.data() + done, text.size() - done);
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return fd >= 0 && lseek(fd, 0, SEEK_SET) == 0;
}

std::vector<std::string> words_of(const Rehearsal& what) {
  std::vector<std::string> words{"ligature-firmware", "rehearse",    "--scene",
                                 what.file,           "--text-from", "/proc/self/fd/0"};
  if (what.no_loss_m_per_s > 0.0) words.insert(words.end(), {"--no-loss", std::to_string(what.no_loss_m_per_s)});
  for (const auto& o : what.overrides) words.insert(words.end(), {"--set", o});
  return words;
}

/// Uses posix_spawn() instead of fork(): fork() marks all our pages copy-on-write, and the loop's next write to each
/// page would then cause a page fault. @return the child's pid, or -1 with errno.
pid_t start(const Rehearsal& what, int in, int out) {
  auto words = words_of(what);
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (auto& w : words) arguments.push_back(w.data());
  arguments.push_back(nullptr);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, in, STDIN_FILENO);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&files, out, STDERR_FILENO);
  posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1);
  posix_spawnattr_t how;
  posix_spawnattr_init(&how);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&how, &none);
  posix_spawnattr_setpgroup(&how, 0);  // so that Ctrl-C does not reach the child
  posix_spawnattr_setflags(&how, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
  pid_t child = -1;
  const int error = posix_spawn(&child, what.program.c_str(), &files, &how, arguments.data(), environ);
  posix_spawnattr_destroy(&how);
  posix_spawn_file_actions_destroy(&files);
  errno = error;
  return error == 0 ? child : -1;
}

/// Appends to `words` what the child has printed so far; text beyond kMostWords characters is dropped.
void hear(int from, std::string& words) {
  std::array<char, 1024> part{};
  const auto n = ::read(from, part.data(), part.size());
  if (n > 0 && words.size() < kMostWords) words.append(part.data(), static_cast<std::size_t>(n));
}

/// The child's exit status as from waitpid(); nothing if the child was killed, because `patience` had passed or
/// `cancelled` was set.
std::optional<int> await(pid_t child, int from, std::chrono::milliseconds patience, const std::atomic<bool>& cancelled,
                         std::string& words) {
  // What it stays if waitpid() fails, as where the parent of this process ignored SIGCHLD: exit code 127, a failure.
  int status = 127 << 8;
  bool killed = false;
  for (const auto give_up = Clock::now() + patience; waitpid(child, &status, WNOHANG) == 0;) {
    if (!killed && (cancelled || Clock::now() >= give_up)) killed = kill(child, SIGKILL) == 0;
    pollfd ready{from, POLLIN, 0};
    if (poll(&ready, 1, 10) > 0 && (ready.revents & POLLIN) != 0)
      hear(from, words);
    else if ((ready.revents & POLLHUP) != 0)
      usleep(1000);
  }
  for (pollfd ready{from, POLLIN, 0}; poll(&ready, 1, 0) > 0 && (ready.revents & POLLIN) != 0;) hear(from, words);
  return killed ? std::nullopt : std::optional(status);
}

/// The child's reason: its last line that begins with the program's name.
std::string reason_in(const std::string& words) {
  constexpr std::string_view kName = "ligature-firmware: ";
  const auto at = words.rfind(kName);
  if (at == std::string::npos) return "no reason given";
  const auto from = at + kName.size();
  return words.substr(from, words.find('\n', from) - from);
}

std::string taken_down(const std::string& file, int status) {
  const std::string remedy = "; allowed a scene that is built within 1 GB of memory and rehearsed in 6 s of CPU time";
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) return file + ": the rehearsal took too long" + remedy;
  const std::string end = WIFSIGNALED(status) ? std::string(strsignal(WTERMSIG(status)))
                                              : "exit code " + std::to_string(WEXITSTATUS(status));
  return file + ": took the process of its rehearsal down (" + end + ")" + remedy;
}

}  // namespace

Verdict rehearse_elsewhere(const Rehearsal& what, const std::atomic<bool>& cancelled) {
  const auto failed = [&](const char* why) {
    return Verdict{what.file + ": cannot be rehearsed: " + why + " (" + std::strerror(errno) + ")", {}};
  };
  const File text(memfd_create("scene", MFD_CLOEXEC));  // a regular file that no other process can change
  if (!write_all(text.fd(), what.text)) return failed("no memory for its text");
  std::array<int, 2> ends{-1, -1};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return failed("no pipe");
  const File from(ends[0]);
  File to(ends[1]);
  const pid_t child = start(what, text.fd(), to.fd());
  if (child < 0) return failed("no process");
  to.close();
  std::string words;
  const auto status = await(child, from.fd(), what.patience, cancelled, words);
  if (!status) return {what.file + ": the rehearsal did not end in time and was ended", {}};
  if (WIFEXITED(*status) && WEXITSTATUS(*status) == 0) return {};
  if (WIFEXITED(*status) && WEXITSTATUS(*status) == 2) return {reason_in(words), {}};
  if (WIFEXITED(*status) && WEXITSTATUS(*status) == 3) return {{}, reason_in(words)};
  return {taken_down(what.file, *status), {}};
}

}  // namespace ligature::app
