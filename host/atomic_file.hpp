#pragma once
#include <cstdio>
#include <string>

namespace ligature::host {

/// A file that exists under its name only when it is complete: written as NAME.part-PID, renamed by commit(),
/// removed when commit() was not reached.
class AtomicFile {
 public:
  /// @throws BadInput when the file cannot be made.
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// @throws RunFailed when the disk does not take it.
  void write(const std::string& text);
  /// Puts it on the disk and under its name. @throws RunFailed.
  void commit();

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  [[noreturn]] void fail(const char* doing) const;

  std::string path_, part_path_;
  std::FILE* file_ = nullptr;
};

}  // namespace ligature::host
