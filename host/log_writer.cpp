#include "host/log_writer.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <lcm/lcm-cpp.hpp>
#include <utility>

#include "host/errors.hpp"
#include "host/log_format.hpp"

namespace ligature::host {
namespace {

bool are_one(const struct stat& a, const struct stat& b) { return a.st_dev == b.st_dev && a.st_ino == b.st_ino; }

}  // namespace

/// Creates the file with O_EXCL, so that two recorders cannot use the same name: LCM's own writer truncates without
/// asking.
LogWriter::Lock::Lock(const std::string& path, bool replace)
    : file_(open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NONBLOCK | (replace ? 0 : O_EXCL), 0666)) {
  if (file_ < 0 && errno == EEXIST) throw BadInput(path + ": exists; allowed: a new name, or --force to replace it");
  if (file_ < 0) throw BadInput(path + ": cannot be written: " + std::strerror(errno));
  struct stat facts = {};
  const bool is_file = fstat(file_, &facts) == 0 && S_ISREG(facts.st_mode);  // a device is not locked
  // On file systems without locks (ENOLCK) the file is written without a lock.
  if (is_file && flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(file_);
    throw BadInput(path + ": is being written by another recorder; allowed: a name of its own for each");
  }
}

LogWriter::Lock::~Lock() { ::close(file_); }

bool LogWriter::Lock::is_of(int file) const {
  struct stat ours = {}, theirs = {};
  return fstat(file_, &ours) == 0 && fstat(file, &theirs) == 0 && are_one(ours, theirs);
}

bool LogWriter::Lock::is_at(const std::string& path) const {
  struct stat ours = {}, theirs = {};
  return fstat(file_, &ours) == 0 && stat(path.c_str(), &theirs) == 0 && are_one(ours, theirs);
}

LogWriter::LogWriter(std::string path, bool replace)
    : path_(std::move(path)), lock_(std::make_unique<Lock>(path_, replace)) {
  if (!replace) begin();
}

/// Empties the file, whose lock is held, and opens it for writing. If a file that was to be replaced has been moved
/// away since it was locked, a new one is made in its place.
void LogWriter::begin() {
  if (!lock_->is_at(path_)) lock_ = std::make_unique<Lock>(path_, false);
  auto file = std::make_unique<lcm::LogFile>(path_, "w");
  if (!file->good()) throw BadInput(path_ + ": cannot be written: " + std::strerror(errno));
  if (!lock_->is_of(fileno(file->getFilePtr()))) throw BadInput(path_ + ": was replaced while it was opened");
  file_ = std::move(file);
  has_begun_ = true;
}

LogWriter::~LogWriter() = default;

bool LogWriter::takes(std::string_view channel, Bytes data) {
  return data.size() <= static_cast<std::size_t>(kLargestData) && channel != kCheckChannel;
}

void LogWriter::write(std::int64_t timestamp_us, std::string_view channel, Bytes data) {
  if (!has_begun_) begin();
  append(timestamp_us, channel, data);
  append(timestamp_us, kCheckChannel, encoded({timestamp_us, log_checksum(channel, data)}));
  if (std::fflush(file_->getFilePtr()) != 0) fail();
}

void LogWriter::append(std::int64_t timestamp_us, std::string_view channel, Bytes data) {
  lcm::LogEvent event;
  event.timestamp = timestamp_us;
  event.channel = channel;
  event.datalen = static_cast<std::int32_t>(data.size());
  event.data = const_cast<std::byte*>(data.data());  // writeEvent() only reads it
  if (file_->writeEvent(&event) != 0) fail();
  bytes_ += static_cast<std::int64_t>(LogEventHead::kBytes + channel.size() + data.size());
}

void LogWriter::close() {
  if (!file_) return;
  // fdatasync reports EINVAL for a device such as /dev/null. On a file, a full disk may show only here.
  if (fdatasync(fileno(file_->getFilePtr())) != 0 && errno != EINVAL && errno != EROFS) fail();
  file_.reset();
}

void LogWriter::fail() const {
  throw RunFailed(path_ + ": writing failed: " + std::strerror(errno) +
                  "; the log ends there, what came before is kept");
}

}  // namespace ligature::host
