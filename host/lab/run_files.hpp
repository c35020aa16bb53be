#pragma once
// The two tables that a run writes while it proceeds. Numbers are printed so that they read back exactly.

#include <cstdio>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>

#include "firmware/physics/simulation.hpp"

namespace ligature::lab {

struct TraceRow {
  double t_s = 0.0;
  physics::Vec3 left_N = physics::Vec3::Zero();  ///< force on the hand in the thread's world, N, before force_scale
  physics::Vec3 right_N = physics::Vec3::Zero();
  double kinetic_J = 0.0;
  double potential_J = 0.0;
  double max_stretch = 0.0;
  double min_gap_m = 0.0;
  int contacts = 0;
  double step_us = 0.0;

  [[nodiscard]] bool is_finite() const noexcept;
};

/// A CSV file that gets its name only when it is complete: written as NAME.part, renamed by close(), removed otherwise.
/// Until then an older file of that name stays. @throws Refusal when it cannot be created, and with exit code 3 when
/// the disk is full.
class CsvFile {
 public:
  CsvFile(const std::filesystem::path& path, const char* header);
  ~CsvFile();
  CsvFile(const CsvFile&) = delete;
  CsvFile& operator=(const CsvFile&) = delete;
  /// Writes one row; each number in its shortest exact form.
  void row(std::span<const double> cells);
  /// Writes everything to NAME.part, for files that are to get their names together; then close() only renames.
  void finish();
  void close();

 private:
  [[noreturn]] void fail();

  std::string path_, part_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::string line_;
};

class TraceFile {
 public:
  explicit TraceFile(const std::filesystem::path& folder);
  void add(const TraceRow& row);
  void finish() { file_.finish(); }
  void close() { file_.close(); }

 private:
  CsvFile file_;
};

class ShapeFile {
 public:
  explicit ShapeFile(const std::filesystem::path& folder);
  void add(double t_s, std::span<const physics::Vec3> nodes_W);
  void finish() { file_.finish(); }
  void close() { file_.close(); }

 private:
  CsvFile file_;
};

/// Creates the folder of a run. @throws Refusal.
void make_folder(const std::filesystem::path& folder);

/// Checks, before anything is run, that nothing but a file has the name of a file that will be written. @throws
/// Refusal.
void check_outputs(const std::filesystem::path& folder, std::initializer_list<const char*> names);

/// Checks, before anything is run, the file that an option names: a new or a regular file, in a folder that exists.
/// @return the file to write; a symbolic link is followed, so that it is kept. @throws Refusal.
[[nodiscard]] std::filesystem::path checked_file(const std::string& option, const std::filesystem::path& given);

/// Removes the files of an earlier run, so that they cannot be taken for results of a run that failed. Removes none
/// when one of them is no file. @throws Refusal.
void remove_old_outputs(const std::filesystem::path& folder, std::initializer_list<const char*> names);

/// Writes a text file atomically (temporary file, then rename). @throws Refusal.
void write_text(const std::filesystem::path& path, const std::string& text);

}  // namespace ligature::lab
