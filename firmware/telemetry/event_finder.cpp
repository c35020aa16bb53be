#include "firmware/telemetry/event_finder.hpp"

#include <utility>

#include "firmware/telemetry/in_words.hpp"
#include "ligature_msg/tick_t.hpp"

namespace ligature::telemetry {
namespace {

constexpr const char* kHandNames[] = {"left", "right"};
constexpr int kOff = ligature_msg::tick_t::STATE_OFF, kCalibrate = ligature_msg::tick_t::STATE_CALIBRATE;

ligature_msg::event_t event(std::int64_t tick, std::int8_t kind, std::int8_t hand, std::int32_t code,
                            std::string text) {
  ligature_msg::event_t e{};
  e.tick = tick;
  e.kind = kind;
  e.hand = hand;
  e.code = code;
  e.text = std::move(text);
  return e;
}

}  // namespace

/// What the rig waits for in OFF or CALIBRATE, if it is time to say so: after kFirstWord, then every kNextWord.
std::string EventFinder::find_wait(const rt::TickRecord& r) {
  if (r.state != last_.state) since_tick_ = r.tick, next_word_tick_ = r.tick + kFirstWord;
  const bool waits = (r.state == kOff || r.state == kCalibrate) && r.culprit.hand >= 0;
  if (!waits || r.tick < next_word_tick_) return {};
  next_word_tick_ = r.tick + kNextWord;
  return std::string(names_.state(r.state)) + " for " + std::to_string((r.tick - since_tick_) / kTicksPerSecond) +
         (r.state == kOff ? " s, waits for: " : " s, because the angles are no possible pose: ") + in_words(r.culprit);
}

std::vector<ligature_msg::event_t> EventFinder::next(const rt::TickRecord& r) {
  using ligature_msg::event_t;
  std::vector<event_t> events;
  if ((r.flags & rt::kPeriodLost) != 0) return events;
  if (r.fault != last_.fault && r.fault != 0) {
    events.push_back(event(r.tick, event_t::KIND_FAULT, r.culprit.hand, r.fault,
                           fault_in_words(r.fault, names_.fault(r.fault), r.culprit)));
  }
  if (r.state != last_.state) {
    events.push_back(event(r.tick, event_t::KIND_STATE, -1, r.state,
                           std::string(names_.state(last_.state)) + " -> " + names_.state(r.state)));
  }
  if (std::string text = find_wait(r); !text.empty())
    events.push_back(event(r.tick, event_t::KIND_WAITS, r.culprit.hand, r.state, std::move(text)));
  for (std::size_t h = 0; h < rt::kHands; ++h) {
    const auto hand = static_cast<std::int8_t>(h);
    const std::string who = kHandNames[h];
    // A remesh may renumber the held node, so only held or not is compared
    const int was = last_.grasped_node[h], is = r.grasped_node[h];
    if (was >= 0 && is < 0) {
      events.push_back(event(r.tick, event_t::KIND_RELEASE, hand, was, who + " releases node " + std::to_string(was)));
    }
    if (was < 0 && is >= 0) {
      events.push_back(event(r.tick, event_t::KIND_GRASP, hand, is, who + " grasps node " + std::to_string(is)));
    }
    if (r.grip[h] && !last_.grip[h] && is < 0) {
      events.push_back(event(r.tick, event_t::KIND_GRASP, hand, -1, who + " closes on nothing"));
    }
    const std::int32_t limited = h == 0 ? rt::kLeftLimited : rt::kRightLimited;
    if ((r.flags & limited) != 0 && (last_.flags & limited) == 0) {
      events.push_back(event(r.tick, event_t::KIND_LIMIT, hand, 0, who + " force reaches its limit"));
    }
  }
  last_ = r;
  return events;
}

}  // namespace ligature::telemetry
