#include "host/viewer_topics.hpp"

#include <bit>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "host/names.hpp"

namespace ligature::host {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
void append(std::string& to, T value) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  to.append(digits, end);
}

void append_real(std::string& to, double value) {
  if (value == 0.0)
    to += std::signbit(value) ? "-0.0" : "0.0";  // "-0" would be read as the integer 0, without its sign
  else if (std::isfinite(value))
    append(to, value);
  else
    to += "null";
}

/// The topic of a column: one for each hand ("left_.." and "right_.."), the rest is on /rig.
std::size_t topic_of(std::string_view column) {
  for (std::size_t hand = 0; hand < std::size(kHandNames); ++hand)
    if (column.starts_with(std::string(kHandNames[hand]) + "_")) return kLeftTopic + hand;
  return kRigTopic;
}

std::string field_name(std::string_view column) {
  const std::size_t topic = topic_of(column);
  if (topic == kRigTopic) return std::string(column);
  return std::string(column.substr(std::string_view(kHandNames[topic - kLeftTopic]).size() + 1));
}

Json described(const char* type, const std::string& meaning, const std::string& unit) {
  return {{"type", type}, {"description", unit.empty() ? meaning : meaning + " [" + unit + "]"}};
}

std::string schema_text(const std::string& title, Json properties) {
  return Json{{"title", title}, {"type", "object"}, {"properties", std::move(properties)}}.dump();
}

ViewerTopic make_topic(const std::string& name, const std::string& schema_name, Json properties) {
  return {name, schema_name, schema_text(schema_name, std::move(properties))};
}

std::array<ViewerTopic, kViewerTopics> make_topics() {
  std::array<Json, 3> fields{Json::object(), Json::object(), Json::object()};
  for (const auto& column : tick_columns()) {
    const char* type = std::holds_alternative<TickColumn::Real>(column.value) ? "number" : "integer";
    fields[topic_of(column.name)][field_name(column.name)] = described(type, column.meaning, column.unit);
  }
  fields[kRigTopic]["session"] = described("integer", kSessionMeaning, "");
  const Json event{{"tick", described("integer", "period of the event", "ticks")},
                   {"kind", described("integer", "KIND_ value of event_t", "")},
                   {"hand", described("integer", "0 left, 1 right, -1 neither or both", "")},
                   {"code", described("integer", "node, state or fault; see event_t", "")},
                   {"text", described("string", "one line for people", "")}};
  const Json scene{{"entities", {{"type", "array"}, {"items", {{"type", "object"}}}}}};
  return {make_topic("/rig", "ligature.rig", fields[kRigTopic]),
          make_topic("/left", "ligature.left", fields[kLeftTopic]),
          make_topic("/right", "ligature.right", fields[kRightTopic]),
          make_topic("/thread", "foxglove.SceneUpdate", scene), make_topic("/events", "ligature.event", event)};
}

}  // namespace

const std::array<ViewerTopic, kViewerTopics>& viewer_topics() {
  static const auto topics = make_topics();
  return topics;
}

TickJson::TickJson() {
  const auto add = [this](std::size_t topic, const std::string& name, const TickColumn* column) {
    std::string key = '"' + name + "\":";
    const std::size_t bytes = key.size();
    fields_[topic].push_back({column, std::move(key), bytes, 0});
  };
  for (const auto& column : tick_columns()) add(topic_of(column.name), field_name(column.name), &column);
  add(kRigTopic, "session", nullptr);
}

void TickJson::update(Field& field, const ligature_msg::tick_t& tick, int session) const {
  const auto* real = field.column ? std::get_if<TickColumn::Real>(&field.column->value) : nullptr;
  const double number = real ? (*real)(tick) : 0.0;
  const std::int64_t whole = real ? 0 : field.column ? std::get<TickColumn::Whole>(field.column->value)(tick) : session;
  const auto bits = real ? std::bit_cast<std::uint64_t>(number) : static_cast<std::uint64_t>(whole);
  if (field.is_written && bits == field.bits) return;
  field.bits = bits;
  field.is_written = true;
  field.text.resize(field.key_bytes);
  if (real)
    append_real(field.text, number);
  else
    append(field.text, whole);
}

const std::array<std::string, 3>& TickJson::write(const ligature_msg::tick_t& tick, int session) {
  for (std::size_t topic = 0; topic < fields_.size(); ++topic) {
    std::string& message = messages_[topic];
    message.clear();
    for (Field& field : fields_[topic]) {
      update(field, tick, session);
      message += message.empty() ? '{' : ',';
      message += field.text;
    }
    message += '}';
  }
  return messages_;
}

std::string shape_json(const ligature_msg::thread_t& thread, std::uint64_t time_ns) {
  constexpr std::uint64_t kSecond = 1'000'000'000;
  std::string text = R"({"deletions":[],"entities":[{"timestamp":{"sec":)";
  append(text, time_ns / kSecond);
  text += R"(,"nsec":)";
  append(text, time_ns % kSecond);
  text += R"(},"frame_id":"W","id":"thread","lifetime":{"sec":0,"nsec":0},"frame_locked":false,"metadata":[],)"
          R"("arrows":[],"cubes":[],"spheres":[],"cylinders":[],"triangles":[],"texts":[],"models":[],)"
          R"("lines":[{"type":0,"pose":{"position":{"x":0,"y":0,"z":0},"orientation":{"x":0,"y":0,"z":0,"w":1}},)"
          R"("scale_invariant":false,"color":{"r":0.85,"g":0.73,"b":0.5,"a":1},"colors":[],"indices":[],"thickness":)";
  append_real(text, 2.0 * static_cast<double>(thread.radius_m));
  text += R"(,"points":[)";
  for (std::size_t node = 0; node < thread.p_W_m.size(); ++node) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      text += axis == 0 ? (node == 0 ? R"({"x":)" : R"(,{"x":)") : axis == 1 ? R"(,"y":)" : R"(,"z":)";
      append_real(text, thread.p_W_m[node][axis]);
    }
    text += '}';
  }
  return text += "]}]}]}";
}

std::string event_json(const ligature_msg::event_t& event) {
  const Json json{
      {"tick", event.tick}, {"kind", event.kind}, {"hand", event.hand}, {"code", event.code}, {"text", event.text}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::uint64_t viewer_time_ns(double t_s) { return t_s > 0.0 ? static_cast<std::uint64_t>(std::llround(t_s * 1e9)) : 0; }

}  // namespace ligature::host
