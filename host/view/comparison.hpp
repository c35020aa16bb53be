#pragma once
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "host/view/log_map.hpp"
#include "host/view/log_survey.hpp"
#include "host/view/picture.hpp"
#include "host/view/player.hpp"

namespace ligature::host::view {

/// A second recording beside the one that is played: its traces go to the pages too, at the same place of what both
/// have in common: their first tick, or their first grasp. The server's thread only.
class Comparison {
 public:
  /// @param folder whose recordings a page may choose from; empty: none.
  Comparison(const LogMap& map, const LogSurvey& survey, Picture& picture, std::filesystem::path folder);
  ~Comparison();

  /// {"compare": "NAME" or "", "align": "start" or "grasp"}. @return null, or an answer that says why not.
  [[nodiscard]] nlohmann::json request(const nlohmann::json& message);

  /// @throws BadInput when it is no recording.
  void open(const std::filesystem::path& path, const std::string& align);

  /// Plays along; once both recordings have been read far enough to know where they meet.
  void follow(double position_s, Picture::Clock::time_point now);

 private:
  struct Other;
  void close();
  void find_offset();
  void tell(const std::string& why = "");

  const LogMap& map_;
  const LogSurvey& survey_;
  Picture& picture_;
  std::filesystem::path folder_;
  std::unique_ptr<Other> other_;
};

}  // namespace ligature::host::view
