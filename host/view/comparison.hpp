#pragma once
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "host/view/log_survey.hpp"
#include "host/view/picture.hpp"
#include "host/view/player.hpp"

namespace ligature::host::view {

/// Shows the traces of a second recording together with the one that is played. The two are aligned at their first tick
/// or at their first grasp. Used on the server's thread only.
class Comparison {
 public:
  /// @param folder whose recordings a page may choose; empty: none.
  Comparison(const LogSurvey& survey, Picture& picture, std::filesystem::path folder);
  ~Comparison();

  /// Handles {"compare": "NAME" or "", "align": "start" or "grasp"}. @return null, or an answer with the reason for a
  /// refusal.
  [[nodiscard]] nlohmann::json request(const nlohmann::json& message);

  /// Opens the second recording. @throws BadInput when the file is no recording.
  void open(const std::filesystem::path& path, const std::string& align);

  /// Plays the second recording in step with the first; begins once both are read far enough to be aligned.
  void follow(double position_s, Picture::Clock::time_point now);

 private:
  struct Other;
  void close();
  void find_offset();
  void tell(const std::string& why = "");

  const LogSurvey& survey_;
  Picture& picture_;
  std::filesystem::path folder_;
  std::unique_ptr<Other> other_;
};

}  // namespace ligature::host::view
