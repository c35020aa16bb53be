#include "host/regular_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "host/errors.hpp"

namespace ligature::host {
namespace {

// O_NONBLOCK: without it, opening a pipe waits for its other end, and reading /proc/kmsg waits for the next message.
constexpr int kHow = O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY;

}  // namespace

RegularFile::RegularFile(const std::string& path) : file_(open(path.c_str(), kHow)) { check(path); }

RegularFile::RegularFile(const std::filesystem::path& folder, const std::filesystem::path& name) {
  if (name.empty() || name.has_parent_path() || name == "." || name == "..")
    throw BadInput(name.string() + ": allowed: the name of a file in " + folder.string());
  const int in = open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
  if (in >= 0) {
    file_ = openat(in, name.c_str(), kHow | O_NOFOLLOW);
    const int why = errno;
    close(in);
    errno = why;
  }
  check((folder / name).string());
}

void RegularFile::check(const std::string& path) {
  struct stat facts = {};
  if (file_ < 0 || fstat(file_, &facts) != 0) {
    const std::string why = std::strerror(errno);
    if (file_ >= 0) close(file_);
    throw BadInput(path + ": cannot be read: " + why);
  }
  if (!S_ISREG(facts.st_mode)) {
    close(file_);
    throw BadInput(path + ": " + (S_ISDIR(facts.st_mode) ? "is a folder" : "is a device, pipe or socket") +
                   "; allowed: a regular file");
  }
  size_ = facts.st_size;
}

RegularFile::RegularFile(RegularFile&& other) noexcept : file_(std::exchange(other.file_, -1)), size_(other.size_) {}

RegularFile::~RegularFile() {
  if (file_ >= 0) close(file_);
}

std::size_t RegularFile::read_at(void* to, std::size_t bytes, std::int64_t offset) const {
  std::size_t done = 0;
  while (done < bytes) {
    const ssize_t got =
        pread(file_, static_cast<char*>(to) + done, bytes - done, offset + static_cast<std::int64_t>(done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

std::int64_t RegularFile::data_after(std::int64_t offset) const {
  const off_t found = lseek(file_, offset, SEEK_DATA);
  if (found >= 0) return found;
  // ENXIO: only a hole follows; otherwise the file system does not support holes
  return errno == ENXIO ? size_ : offset;
}

}  // namespace ligature::host
