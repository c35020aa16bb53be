#pragma once
// The two tables a run writes while it goes. Numbers are printed so that they read back exactly.

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
  physics::Vec3 left_N = physics::Vec3::Zero();  ///< on the hand, world newtons, before force_scale
  physics::Vec3 right_N = physics::Vec3::Zero();
  double kinetic_J = 0.0;
  double potential_J = 0.0;
  double max_stretch = 0.0;
  double min_gap_m = 0.0;
  int contacts = 0;
  double step_us = 0.0;

  [[nodiscard]] bool is_finite() const noexcept;
};

/// A CSV file that has its name only when it is complete: written as NAME.part, renamed by close(), removed when that
/// was not reached. Throws Refusal when it cannot be made, or (exit 3) when the disk fills.
class CsvFile {
 public:
  CsvFile(const std::filesystem::path& path, const char* header);
  ~CsvFile();
  CsvFile(const CsvFile&) = delete;
  CsvFile& operator=(const CsvFile&) = delete;
  /// One row; each number in its shortest exact form.
  void row(std::span<const double> cells);
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
  void close() { file_.close(); }

 private:
  CsvFile file_;
};

class ShapeFile {
 public:
  explicit ShapeFile(const std::filesystem::path& folder);
  void add(double t_s, std::span<const physics::Vec3> nodes_W);
  void close() { file_.close(); }

 private:
  CsvFile file_;
};

/// Makes the folder of a run, or throws Refusal.
void make_folder(const std::filesystem::path& folder);

/// Removes what an earlier run left in the folder, so that one that fails or is killed leaves nothing that looks like
/// its own. @throws Refusal.
void remove_old_outputs(const std::filesystem::path& folder,
                        std::initializer_list<const char*> names = {"summary.json", "trace.csv", "shape.csv"});

/// Writes a text file in one go (beside it first, then renamed over it), or throws Refusal.
void write_text(const std::filesystem::path& path, const std::string& text);

}  // namespace ligature::lab
