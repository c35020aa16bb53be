#include "firmware/app/doctor/report_file.hpp"

#include <unistd.h>

#include <filesystem>
#include <span>

#include "firmware/telemetry/disk.hpp"

namespace ligature::app {
namespace {

/// The file that a report ends up in: a link is kept, and its target replaced.
std::filesystem::path place_of_report(const std::string& path) {
  std::error_code none;
  const auto target = std::filesystem::canonical(path, none);
  return target.empty() ? std::filesystem::absolute(path, none) : target;
}

}  // namespace

std::string objection_to_report(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code none;
  const auto found = fs::status(path, none);
  const bool is_loose_link = !fs::exists(found) && fs::is_symlink(fs::symlink_status(path, none));
  if (is_loose_link || (fs::exists(found) && !fs::is_regular_file(found)))
    return "is no regular file, allowed one or a new name";
  if (access(place_of_report(path).parent_path().c_str(), W_OK | X_OK) != 0)
    return "cannot be written, allowed a file in a folder that exists";
  return {};
}

bool write_report(const std::string& path, const DoctorReport& report) {
  if (!objection_to_report(path).empty()) return false;  // the path may have changed since the start
  const std::string text = to_json(report);
  return telemetry::write_whole_file(place_of_report(path).string(), std::as_bytes(std::span(text)));
}

}  // namespace ligature::app
