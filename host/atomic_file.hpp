#pragma once
#include <cstdio>
#include <string>

namespace ligature::host {

/// Where writing to `path` really goes: symbolic links followed, also one that points at nothing yet.
/// @throws BadInput when something is there that is no regular file (a device, a pipe, a folder): a file that appears
/// by renaming would take its place.
[[nodiscard]] std::string file_to_write(const std::string& path);

/// A file that exists under its name only when it is complete: written as NAME.part-PID, renamed by commit(),
/// removed when commit() was not reached. A symbolic link stays one: its target is what is replaced.
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
  /// Where it is until commit(), for those who write it by other means; they have closed or flushed it before.
  [[nodiscard]] const std::string& part_path() const { return part_path_; }

 private:
  [[noreturn]] void fail(const char* doing) const;

  std::string path_, part_path_;
  std::FILE* file_ = nullptr;
};

}  // namespace ligature::host
