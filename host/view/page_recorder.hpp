#pragma once
#include <filesystem>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

#include "host/lcm_link.hpp"
#include "host/log_writer.hpp"
#include "host/view/access.hpp"
#include "host/view/picture.hpp"

namespace ligature::host::view {

/// Records the rig at a page's request into a folder that was chosen at the program's start: a page gives a file name,
/// never a path.
class PageRecorder {
 public:
  static constexpr std::string_view kNotesChannel = "LIGATURE_NOTES";  // payload: UTF-8 text, not an LCM type
  static constexpr std::size_t kLongestNotes = 2000;

  PageRecorder(const Access& access, std::filesystem::path folder, Picture& picture);

  /// Handles {"record": "start", "name": "knot-1", "notes": "...", "id", "token"}, {"record": "stop", ...} or
  /// {"record": "list", ...}. @return the answer; that to "list" has the folder's recordings in `files`.
  [[nodiscard]] nlohmann::json request(const nlohmann::json& message);

  /// Records a message while a recording runs; called on the LCM thread. A full disk ends the recording.
  void take(const Message& message);

 private:
  [[nodiscard]] std::string start(const std::string& name, const std::string& notes);
  void stop(const std::string& why);
  void tell(const std::string& why = "");

  const Access& access_;
  std::filesystem::path folder_;
  Picture& picture_;
  std::mutex mutex_;
  std::unique_ptr<LogWriter> log_;
  std::string file_;
  std::int64_t messages_ = 0;
};

}  // namespace ligature::host::view
