#pragma once
// The file of a flight recorder as a place for bytes. Any call may take as long as the disk likes.

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <variant>

namespace ligature::telemetry {

class Disk {
 public:
  virtual ~Disk() = default;
  /// @return false when the disk did not take all of it.
  virtual bool write(std::span<const std::byte> bytes, std::size_t at) noexcept = 0;
  virtual bool read(std::span<std::byte> bytes, std::size_t at) noexcept = 0;
  /// Returns when all that was written before is on the disk itself. May be called by another thread.
  virtual void sync() noexcept = 0;
};

/// A file of fixed size, all its blocks taken, locked against a second writer. What is written lies in the kernel's
/// page cache at once, so it survives SIGKILL of any process. It is written with pwrite() and not through a mapping: a
/// mapped page that the disk is busy with stops the thread that touches it inside the address space's lock, where every
/// other thread of this process may meet it, and a disk that fails would end the process.
class FileDisk final : public Disk {
 public:
  /// The file of an earlier run is kept once, as FILE.previous. @return the file, or one line that says why there is
  /// none.
  [[nodiscard]] static std::variant<std::unique_ptr<FileDisk>, std::string> make(const std::string& path,
                                                                                 std::size_t size);
  ~FileDisk() override;
  FileDisk(const FileDisk&) = delete;
  FileDisk& operator=(const FileDisk&) = delete;

  bool write(std::span<const std::byte> bytes, std::size_t at) noexcept override;
  bool read(std::span<std::byte> bytes, std::size_t at) noexcept override;
  void sync() noexcept override;

 private:
  explicit FileDisk(int fd) : fd_(fd) {}
  int fd_;
};

/// A file of these bytes, complete and on the disk, or none. @return false for none.
[[nodiscard]] bool write_whole_file(const std::string& path, std::span<const std::byte> bytes);

}  // namespace ligature::telemetry
