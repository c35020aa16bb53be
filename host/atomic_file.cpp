#include "host/atomic_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "host/errors.hpp"

namespace ligature::host {

std::string file_to_write(const std::string& path) {
  namespace fs = std::filesystem;
  constexpr int kMostLinks = 40;  // the kernel's own limit
  std::error_code none;
  fs::path target(path);
  for (int i = 0; fs::is_symlink(fs::symlink_status(target, none)); ++i) {
    if (i == kMostLinks) throw BadInput(path + ": is a circle of links; allowed: the name of a file");
    // operator/ discards the left side when the link is absolute
    target = target.parent_path() / fs::read_symlink(target, none);
  }
  const auto found = fs::status(target, none);
  if (fs::is_directory(found)) throw BadInput(path + ": is a folder; allowed: the name of a file");
  if (fs::exists(found) && !fs::is_regular_file(found))
    throw BadInput(path + ": is a device, pipe or socket; allowed: a regular file, or a new name");
  return target.string();
}

AtomicFile::AtomicFile(const std::string& path) : path_(file_to_write(path)) {
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
