#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace ligature::host {

/// A regular file, opened for reading. Whoever names a file (a person, a message from the network) cannot make the
/// reader wait: a pipe, a socket, a device or a folder is refused and never waited for.
class RegularFile {
 public:
  /// Symbolic links are followed. @throws BadInput.
  explicit RegularFile(const std::string& path);
  /// A file of that very folder: no link, and nothing in another folder. @throws BadInput.
  RegularFile(const std::filesystem::path& folder, const std::filesystem::path& name);
  ~RegularFile();
  RegularFile(RegularFile&& other) noexcept;
  RegularFile& operator=(RegularFile&&) = delete;

  [[nodiscard]] int id() const { return file_; }
  [[nodiscard]] std::int64_t size() const { return size_; }  ///< bytes, when it was opened
  /// @return how many bytes were read: fewer at the end of the file, or when the disk refuses.
  std::size_t read_at(void* to, std::size_t bytes, std::int64_t offset) const;
  /// The offset of the first byte at or after `offset` that lies in no hole of a sparse file; size() when there is
  /// none.
  [[nodiscard]] std::int64_t data_after(std::int64_t offset) const;

 private:
  void check(const std::string& path);

  int file_ = -1;
  std::int64_t size_ = 0;
};

}  // namespace ligature::host
