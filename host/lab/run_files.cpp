#include "host/lab/run_files.hpp"

#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <system_error>

#include "host/lab/outcome.hpp"

namespace ligature::lab {

bool TraceRow::is_finite() const noexcept {
  return left_N.allFinite() && right_N.allFinite() && std::isfinite(kinetic_J) && std::isfinite(potential_J) &&
         std::isfinite(max_stretch) && std::isfinite(min_gap_m);
}

CsvFile::CsvFile(const std::filesystem::path& path, const char* header)
    : path_(path.string()), part_(path_ + ".part"), file_(std::fopen(part_.c_str(), "w"), &std::fclose) {
  if (!file_) throw Refusal(path_ + ": cannot be written: " + std::strerror(errno));
  if (std::fprintf(file_.get(), "%s\n", header) < 0) fail();
}

CsvFile::~CsvFile() {
  if (part_.empty()) return;  // it has its name
  file_.reset();
  std::remove(part_.c_str());
}

void CsvFile::row(std::span<const double> cells) {
  line_.clear();
  for (const double cell : cells) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, cell).ptr;
    if (!line_.empty()) line_ += ',';
    line_.append(text, end);
  }
  line_ += '\n';
  if (std::fwrite(line_.data(), 1, line_.size(), file_.get()) != line_.size()) fail();
}

void CsvFile::finish() {
  if (std::fflush(file_.get()) != 0) fail();
  file_.reset();
}

void CsvFile::close() {
  if (file_) finish();
  if (std::rename(part_.c_str(), path_.c_str()) != 0) fail();
  part_.clear();
}

void CsvFile::fail() {
  const std::string why = std::strerror(errno);
  file_.reset();
  std::remove(part_.c_str());
  throw Refusal(path_ + ": cannot be written: " + why + "; nothing was written under that name", kRunFailed);
}

TraceFile::TraceFile(const std::filesystem::path& folder)
    : file_(folder / "trace.csv",
            "t_s,left_fx_N,left_fy_N,left_fz_N,right_fx_N,right_fy_N,right_fz_N,kinetic_J,potential_J,max_stretch,min_"
            "gap_m,"
            "contacts,step_us") {}

void TraceFile::add(const TraceRow& r) {
  const double cells[] = {r.t_s,         r.left_N.x(),  r.left_N.y(),  r.left_N.z(),
                          r.right_N.x(), r.right_N.y(), r.right_N.z(), r.kinetic_J,
                          r.potential_J, r.max_stretch, r.min_gap_m,   static_cast<double>(r.contacts),
                          r.step_us};
  file_.row(cells);
}

ShapeFile::ShapeFile(const std::filesystem::path& folder) : file_(folder / "shape.csv", "t_s,node,x_m,y_m,z_m") {}

void ShapeFile::add(double t_s, std::span<const physics::Vec3> nodes_W) {
  for (std::size_t k = 0; k < nodes_W.size(); ++k) {
    const double cells[] = {t_s, static_cast<double>(k), nodes_W[k].x(), nodes_W[k].y(), nodes_W[k].z()};
    file_.row(cells);
  }
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    throw Refusal("--out " + folder.string() + ": found " + (error ? error.message() : "a file") +
                  ", allowed a folder that can be written");
  }
}

void check_outputs(const std::filesystem::path& folder, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    std::error_code none;
    const auto path = folder / name;
    const auto found = std::filesystem::symlink_status(path, none);
    if (!std::filesystem::exists(found) || std::filesystem::is_regular_file(found)) continue;
    if (!std::filesystem::is_symlink(found))
      throw Refusal(path.string() + ": is no file, allowed a regular file or a new name");
  }
}

std::filesystem::path checked_file(const std::string& option, const std::filesystem::path& given) {
  namespace fs = std::filesystem;
  const auto refuse = [&](const std::string& found) {
    throw Refusal(option + " " + given.string() + ": found " + found +
                  ", allowed a new or a regular file in a folder that exists");
  };
  std::error_code none;
  const auto found = fs::status(given, none);
  if (fs::is_directory(found)) refuse("a folder");
  if (fs::exists(found) && !fs::is_regular_file(found)) refuse("a device, pipe or socket");
  const bool is_link = fs::is_symlink(fs::symlink_status(given, none));
  if (is_link && !fs::exists(found)) refuse("a link to nothing");
  const fs::path file = is_link ? fs::canonical(given, none) : fs::absolute(given, none);
  const fs::path folder = file.parent_path();
  if (!fs::is_directory(folder, none)) refuse("no folder " + folder.string());
  if (access(folder.c_str(), W_OK) != 0) refuse("a folder that cannot be written");
  return is_link ? file : given;
}

void remove_old_outputs(const std::filesystem::path& folder, std::initializer_list<const char*> names) {
  check_outputs(folder, names);
  for (const char* name : names) {
    std::error_code error;
    std::filesystem::remove(folder / name, error);
    if (error) throw Refusal((folder / name).string() + ": cannot be replaced: " + error.message());
  }
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  const auto part = std::filesystem::path(path.string() + ".part");
  errno = 0;
  std::ofstream file(part);
  file << text;
  file.close();
  const std::string why = std::strerror(errno);
  std::error_code error;
  if (file) std::filesystem::rename(part, path, error);
  if (file && !error) return;
  std::error_code ignored;
  std::filesystem::remove(part, ignored);
  throw Refusal(path.string() + ": cannot be written: " + (error ? error.message() : why), kRunFailed);
}

}  // namespace ligature::lab
