#include "firmware/telemetry/disk.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "protocol/recorder/flight_file.hpp"

namespace ligature::telemetry {
namespace {

std::string refusal(const std::string& path, const char* what, int error) {
  return "flight recorder " + path + ": " + what + " (" + std::strerror(error) + ")";
}

/// Whether a running process records into that file.
bool is_in_use(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return false;
  const bool locked = flock(fd, LOCK_EX | LOCK_NB) != 0;
  close(fd);
  return locked;
}

/// Whether something stands at `path` that no flight recorder wrote: a folder, a device, a link, or another file. A
/// file that begins with zeros is a recording whose process ended before it wrote the header.
bool is_foreign(const std::string& path) {
  struct stat found {};
  if (lstat(path.c_str(), &found) != 0) return false;
  if (!S_ISREG(found.st_mode)) return true;
  std::array<char, recorder::kMagic.size()> begin{};
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return true;
  const bool is_short = pread(fd, begin.data(), begin.size(), 0) != static_cast<ssize_t>(begin.size());
  close(fd);
  return is_short ? found.st_size > 0 : begin != recorder::kMagic && begin != decltype(begin){};
}

bool write_all(int fd, std::span<const std::byte> bytes, std::size_t at) noexcept {
  while (!bytes.empty()) {
    const auto n = pwrite(fd, bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(n));
    at += static_cast<std::size_t>(n);
  }
  return true;
}

}  // namespace

std::variant<std::unique_ptr<FileDisk>, std::string> FileDisk::make(const std::string& path, std::size_t size) {
  if (is_foreign(path)) return "flight recorder " + path + ": is no recording of a flight recorder, name another file";
  if (is_in_use(path)) return "flight recorder " + path + ": another process records into it";
  std::rename(path.c_str(), (path + ".previous").c_str());  // fails harmlessly if there is no earlier file
  const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (fd < 0) return refusal(path, "cannot be made", errno);
  const auto give_up = [&](const char* what, int error) {
    close(fd);
    unlink(path.c_str());
    return refusal(path, what, error);
  };
  if (flock(fd, LOCK_EX | LOCK_NB) != 0) return give_up("cannot be locked", errno);
  // Allocates all blocks now, so that a disk that fills up later loses no tick.
  if (const int e = posix_fallocate(fd, 0, static_cast<off_t>(size)); e != 0) return give_up("no room", e);
  return std::unique_ptr<FileDisk>(new FileDisk(fd));
}

FileDisk::~FileDisk() { close(fd_); }

bool FileDisk::write(std::span<const std::byte> bytes, std::size_t at) noexcept { return write_all(fd_, bytes, at); }

bool FileDisk::read(std::span<std::byte> bytes, std::size_t at) noexcept {
  return pread(fd_, bytes.data(), bytes.size(), static_cast<off_t>(at)) == static_cast<ssize_t>(bytes.size());
}

void FileDisk::sync() noexcept { fdatasync(fd_); }

bool write_whole_file(const std::string& path, std::span<const std::byte> bytes) {
  const std::string draft = path + ".tmp";
  const int fd = ::open(draft.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fd < 0) return false;
  const bool written = write_all(fd, bytes, 0) && fdatasync(fd) == 0;
  close(fd);
  if (written && std::rename(draft.c_str(), path.c_str()) == 0) return true;
  unlink(draft.c_str());
  return false;
}

}  // namespace ligature::telemetry
