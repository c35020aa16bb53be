#include "host/log_writer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <lcm/lcm-cpp.hpp>
#include <utility>

#include "host/errors.hpp"

namespace ligature::host {
namespace {

constexpr std::int64_t kHeaderSize = 28;

/// Makes the file, so that two recorders can never take the same name; the library truncates without asking.
void create(const std::string& path, bool replace) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | (replace ? 0 : O_EXCL), 0666);
  if (file >= 0) {
    close(file);
    return;
  }
  if (errno == EEXIST) throw BadInput(path + ": exists; allowed: a new name, or --force to replace it");
  throw BadInput(path + ": cannot be written: " + std::strerror(errno));
}

}  // namespace

LogWriter::LogWriter(std::string path, bool replace) : path_(std::move(path)) {
  create(path_, replace);
  file_ = std::make_unique<lcm::LogFile>(path_, "w");
  if (!file_->good()) throw BadInput(path_ + ": cannot be written: " + std::strerror(errno));
}

LogWriter::~LogWriter() = default;

void LogWriter::write(std::int64_t timestamp_us, std::string_view channel, Bytes data) {
  lcm::LogEvent event;
  event.timestamp = timestamp_us;
  event.channel = channel;
  event.datalen = static_cast<std::int32_t>(data.size());
  event.data = const_cast<std::byte*>(data.data());  // the library only reads it
  if (file_->writeEvent(&event) != 0 || std::fflush(file_->getFilePtr()) != 0) fail();
  bytes_ += kHeaderSize + static_cast<std::int64_t>(channel.size() + data.size());
}

void LogWriter::close() {
  if (!file_) return;
  // A device like /dev/null has nothing to sync (EINVAL); on a file this is where a full disk may show.
  if (fdatasync(fileno(file_->getFilePtr())) != 0 && errno != EINVAL && errno != EROFS) fail();
  file_.reset();
}

void LogWriter::fail() const {
  throw RunFailed(path_ + ": writing failed: " + std::strerror(errno) +
                  "; the log ends there, what came before is kept");
}

}  // namespace ligature::host
