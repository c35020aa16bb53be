#pragma once
// Storage of a flight recorder. Any call may block for as long as the disk needs.

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <variant>

namespace ligature::telemetry {

class Disk {
 public:
  virtual ~Disk() = default;
  /// @return false if not all bytes could be written.
  virtual bool write(std::span<const std::byte> bytes, std::size_t at) noexcept = 0;
  virtual bool read(std::span<std::byte> bytes, std::size_t at) noexcept = 0;
  /// Returns when all earlier writes are on the disk itself. May be called from another thread.
  virtual void sync() noexcept = 0;
};

/// A file of fixed size with all blocks allocated, locked against a second writer. Written data is in the kernel's page
/// cache at once, so it survives SIGKILL of this process. It uses pwrite() instead of a memory mapping for two reasons.
/// First, a thread that touches a mapped page during its write-back blocks, and it then holds the address space's lock,
/// which other threads need. Second, a disk error on a mapping would kill the process (SIGBUS).
class FileDisk final : public Disk {
 public:
  /// Creates the file; the file of the previous run is kept as FILE.previous. Anything else at the path is left alone.
  /// @return the file, or one line that says why it failed.
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

/// Writes a complete file, synced to the disk, or none. @return false for none.
[[nodiscard]] bool write_whole_file(const std::string& path, std::span<const std::byte> bytes);

}  // namespace ligature::telemetry
