#include "host/atomic_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "host/errors.hpp"

namespace ligature::host {

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)) {
  if (std::filesystem::is_directory(path_)) throw BadInput(path_ + ": is a folder; allowed: the name of a file");
  part_path_ = path_ + ".part-" + std::to_string(getpid());
  file_ = std::fopen(part_path_.c_str(), "wbx");
  if (!file_) throw BadInput(path_ + ": cannot be written: " + std::strerror(errno));
}

AtomicFile::~AtomicFile() {
  if (!file_) return;
  std::fclose(file_);
  std::remove(part_path_.c_str());
}

void AtomicFile::write(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail("writing");
}

void AtomicFile::commit() {
  if (std::fflush(file_) != 0 || fsync(fileno(file_)) != 0) fail("writing");
  if (std::rename(part_path_.c_str(), path_.c_str()) != 0) fail("renaming");
  std::fclose(std::exchange(file_, nullptr));
}

void AtomicFile::fail(const char* doing) const {
  throw RunFailed(path_ + ": " + doing + " failed: " + std::strerror(errno) + "; nothing was left under that name");
}

}  // namespace ligature::host
