#include "host/view/recordings.hpp"

#include <algorithm>
#include <cctype>
#include <chrono>

namespace ligature::host::view {
namespace {

namespace fs = std::filesystem;

struct File {
  std::string name;
  std::uintmax_t bytes;
  double modified_s;
};

double unix_time_s(fs::file_time_type time) {
  const auto since = std::chrono::file_clock::to_sys(time).time_since_epoch();
  return std::chrono::duration<double>(since).count();
}

}  // namespace

bool is_file_name(std::string_view name) {
  const auto is_allowed = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' || c == '.';
  };
  return !name.empty() && name.size() <= kLongestRecordingName && name.front() != '.' &&
         std::ranges::all_of(name, is_allowed);
}

nlohmann::json recordings_in(const fs::path& folder) {
  std::vector<File> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    const std::string name = entry.path().filename();
    if (!name.ends_with(".lcmlog") || !is_file_name(name) || !entry.is_regular_file(none)) continue;
    std::error_code size_error, time_error;  // the file may have been removed by now
    const auto bytes = entry.file_size(size_error);
    const auto time = entry.last_write_time(time_error);
    if (!size_error && !time_error) files.push_back({name, bytes, unix_time_s(time)});
  }
  std::ranges::sort(files, std::ranges::greater{}, &File::modified_s);
  if (files.size() > kMostRecordings) files.resize(kMostRecordings);
  auto told = nlohmann::json::array();
  for (const auto& file : files)
    told.push_back({{"name", file.name}, {"bytes", file.bytes}, {"modified_s", file.modified_s}});
  return told;
}

std::vector<std::string> recording_names(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& file : recordings_in(folder)) names.push_back(file["name"]);
  std::ranges::sort(names);
  return names;
}

}  // namespace ligature::host::view
