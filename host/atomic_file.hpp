#pragma once
#include <cstdio>
#include <string>

namespace ligature::host {

/// The file that a write to `path` ends up in: symbolic links are followed, also one whose target does not exist yet.
/// @throws BadInput when the target exists and is no regular file (a device, a pipe, a folder): commit() renames a new
/// file over it.
[[nodiscard]] std::string file_to_write(const std::string& path);

/// A file that appears under its name only when it is complete. It is written as NAME.part-PID, renamed by commit(),
/// and removed when commit() was not reached. A symbolic link is kept: its target is replaced.
class AtomicFile {
 public:
  /// @throws BadInput when the file cannot be made.
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// @throws RunFailed when writing fails (disk full).
  void write(const std::string& text);
  /// Flushes the file to the disk and renames it to its final name. @throws RunFailed.
  void commit();

  [[nodiscard]] const std::string& path() const { return path_; }
  /// The temporary name, for callers that write the file by other means; they must close or flush it before commit().
  [[nodiscard]] const std::string& part_path() const { return part_path_; }

 private:
  [[noreturn]] void fail(const char* doing) const;

  std::string path_, part_path_;
  std::FILE* file_ = nullptr;
};

}  // namespace ligature::host
