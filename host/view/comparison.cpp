#include "host/view/comparison.hpp"

#include <algorithm>

#include "host/errors.hpp"
#include "host/view/json_text.hpp"
#include "host/view/log_map.hpp"
#include "host/view/recordings.hpp"

namespace ligature::host::view {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

}  // namespace

struct Comparison::Other {
  std::string name, align;
  LogMap map;
  LogSurvey survey;
  Picture picture;
  Player player;
  // added to a tick number of the other recording, gives the corresponding tick of this one
  std::optional<std::int64_t> offset_ticks;
  bool is_whole = false;  // its last jump came after its survey was complete, so that its traces have no holes
  double shift_s = 0.0;   // time in the other log at time 0 of this log

  Other(const fs::path& path, std::string align_)
      : name(path.filename()),
        align(std::move(align_)),
        map(path.string()),
        survey(map),
        player(map, survey, picture) {}
};

Comparison::Comparison(const LogSurvey& survey, Picture& picture, fs::path folder)
    : survey_(survey), picture_(picture), folder_(std::move(folder)) {
  tell();
}

Comparison::~Comparison() { close(); }

void Comparison::close() {
  picture_.show_beside(nullptr);
  other_.reset();
}

json Comparison::request(const json& message) {
  const auto refuse = [&](const std::string& why) {
    return json{{"id", id_of(message)}, {"command", "compare"}, {"accepted", false}, {"text", why}};
  };
  const std::string name = text_of(message, "compare"), align = text_of(message, "align");
  if (align != "start" && align != "grasp") return refuse("align: allowed start, grasp");
  if (name.empty()) {
    close();
    tell();
    return nullptr;
  }
  const auto names = folder_.empty() ? std::vector<std::string>() : recording_names(folder_);
  if (std::ranges::find(names, name) == names.end()) return refuse("allowed: a recording in the same folder");
  try {
    open(folder_ / name, align);
  } catch (const std::exception& error) {
    tell(error.what());
    return refuse(error.what());
  }
  return nullptr;
}

void Comparison::open(const fs::path& path, const std::string& align) {
  auto other = std::make_unique<Other>(path, align);
  close();
  other_ = std::move(other);
  picture_.show_beside(&other_->picture);
  tell();
}

void Comparison::find_offset() {
  const auto ours = survey_.landmarks(), theirs = other_->survey.landmarks();
  if (!ours.first_tick || !theirs.first_tick) return;
  std::int64_t offset = *ours.first_tick - *theirs.first_tick;
  if (other_->align == "grasp") {
    if (ours.first_grasp && theirs.first_grasp) {
      offset = *ours.first_grasp - *theirs.first_grasp;
    } else {
      const bool is_known =
          (ours.first_grasp || survey_.progress() >= 1.0) && (theirs.first_grasp || other_->survey.progress() >= 1.0);
      if (!is_known) return;  // the surveys have not read far enough to find both grasps
      close();
      return tell("one of them has no grasp; align by start");
    }
  }
  const double ticks_apart = static_cast<double>(*ours.first_tick - offset - *theirs.first_tick);
  other_->shift_s = theirs.first_tick_s + ticks_apart * ours.period_s - ours.first_tick_s;
  other_->offset_ticks = offset;
  tell();
}

void Comparison::follow(double position_s, Picture::Clock::time_point now) {
  if (other_ && !other_->offset_ticks) find_offset();
  if (!other_ || !other_->offset_ticks) return;
  // the other recording has now been read completely: jumps to the same time again, so that its traces have no holes
  if (!other_->is_whole && other_->survey.progress() >= 1.0) {
    other_->is_whole = true;
    other_->player.seek(position_s + other_->shift_s, now);
  }
  other_->player.follow(position_s + other_->shift_s, now);
}

void Comparison::tell(const std::string& why) {
  json told = {{"files", folder_.empty() ? std::vector<std::string>() : recording_names(folder_)},
               {"file", ""},
               {"align", "start"},
               {"offset_ticks", nullptr},
               {"why", why}};
  if (other_) {
    told["file"] = other_->name;
    told["align"] = other_->align;
    if (other_->offset_ticks) told["offset_ticks"] = *other_->offset_ticks;
  }
  picture_.set("compare", std::move(told));
}

}  // namespace ligature::host::view
