#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace ligature::host {

/// A regular file opened for reading. Pipes, sockets, devices and folders are refused without waiting, so that a file
/// name from a user or from the network cannot block the reader.
class RegularFile {
 public:
  /// Follows symbolic links. @throws BadInput.
  explicit RegularFile(const std::string& path);
  /// Opens a file directly inside `folder`; symbolic links are refused. @throws BadInput.
  RegularFile(const std::filesystem::path& folder, const std::filesystem::path& name);
  ~RegularFile();
  RegularFile(RegularFile&& other) noexcept;
  RegularFile& operator=(RegularFile&&) = delete;

  [[nodiscard]] int id() const { return file_; }
  [[nodiscard]] std::int64_t size() const { return size_; }  ///< bytes, at the time of opening
  /// @return number of bytes read: fewer than asked at the end of the file or on a read error.
  std::size_t read_at(void* to, std::size_t bytes, std::int64_t offset) const;
  /// Offset of the first byte at or after `offset` that is not in a hole of a sparse file; size() when there is none.
  [[nodiscard]] std::int64_t data_after(std::int64_t offset) const;

 private:
  void check(const std::string& path);

  int file_ = -1;
  std::int64_t size_ = 0;
};

}  // namespace ligature::host
