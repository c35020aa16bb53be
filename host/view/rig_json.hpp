#pragma once
#include <nlohmann/json.hpp>

#include "host/view/frame.hpp"
#include "ligature_msg/event_t.hpp"
#include "ligature_msg/offer_t.hpp"
#include "ligature_msg/status_t.hpp"
#include "ligature_msg/thread_t.hpp"
#include "ligature_msg/tick_t.hpp"

namespace ligature::host::view {

/// Event kind for a change of the knot. The host finds it, so it is no KIND_ of event_t.
inline constexpr int kKnotEvent = 100;

/// A message as JSON for the page; field names and units as in the .lcm files.
[[nodiscard]] nlohmann::json to_json(const ligature_msg::status_t& status);
[[nodiscard]] nlohmann::json to_json(const ligature_msg::event_t& event);
[[nodiscard]] nlohmann::json to_json(const ligature_msg::offer_t& offer);

/// The names of host/names.hpp as the page needs them: {states: [..], limits: [[bit, name]..], degradations: [..],
/// conditions: [..], faults: [[number, ..]..]}.
[[nodiscard]] nlohmann::json names_json();

/// State, hands and counters of one tick as doubles, in the order that page/frame.js reads.
void write_tick(FrameWriter& frame, const ligature_msg::tick_t& tick);

/// Whether a shape can be drawn: its positions are finite, its radius is positive, and it has no more nodes than a
/// scene may have.
[[nodiscard]] bool is_drawable(const ligature_msg::thread_t& thread);

}  // namespace ligature::host::view
