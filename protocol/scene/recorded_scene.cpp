#include "protocol/scene/recorded_scene.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

#include "protocol/recorder/crc32.hpp"
#include "protocol/scene/cells.hpp"
#include "protocol/scene/scene_file.hpp"

namespace ligature::scene {
namespace {

constexpr std::string_view kAsRun = "\n# as run:", kSet = "# --set ", kShape = "# shape ", kSamples = "# samples ";

/// Checksum of the start shape's points; independent of the file's name and comments.
std::uint32_t shape_of(const Scene& scene) {
  return recorder::crc32(std::as_bytes(std::span(scene.suture.initial_polyline_m)));
}

std::string hex(std::uint32_t number) {
  char digits[8];
  return {digits, std::to_chars(digits, digits + sizeof digits, number, 16).ptr};
}

template <typename Number>
std::optional<Number> number_in(std::string_view digits, int base) {
  Number number = 0;
  if (std::from_chars(digits.data(), digits.data() + digits.size(), number, base).ec != std::errc{}) return {};
  return number;
}

}  // namespace

std::string_view key_of(std::string_view override) { return trim(override.substr(0, override.find('='))); }

void add_override(std::string& recorded, std::string_view override) {
  recorded.append("\n").append(kSet).append(override);
}

void add_earliest_samples(std::string& recorded, std::int64_t after_ns) {
  recorded.append("\n").append(kSamples).append(std::to_string(after_ns));
}

std::string recorded_text(std::string text, std::span<const std::string> overrides, const Scene& scene) {
  text += kAsRun;
  if (!scene.suture.initial_polyline_m.empty()) text.append("\n").append(kShape).append(hex(shape_of(scene)));
  for (const auto& o : overrides) add_override(text, o);
  return text;
}

/// Searches for the last line "# as run:": a text that was taken from a recording may contain such lines already.
RecordedScene split_recorded(const std::string& recorded) {
  RecordedScene found{recorded, {}, {}};
  const auto at = recorded.rfind(kAsRun);
  if (at == std::string::npos) return found;
  found.text.resize(at);
  std::string_view rest = std::string_view(recorded).substr(at + kAsRun.size());
  while (!rest.empty()) {
    const auto end = std::min(rest.find('\n'), rest.size());
    const auto line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (line.starts_with(kSet)) found.overrides.emplace_back(line.substr(kSet.size()));
    if (line.starts_with(kShape)) found.shape = number_in<std::uint32_t>(line.substr(kShape.size()), 16);
    if (line.starts_with(kSamples))
      found.samples_earliest_ns = number_in<std::int64_t>(line.substr(kSamples.size()), 10).value_or(0);
  }
  return found;
}

std::variant<Scene, Error> parse_recorded(const std::string& recorded, const std::string& path,
                                          std::span<const std::string> overrides) {
  const RecordedScene was = split_recorded(recorded);
  auto as_run = parse_scene(was.text, path, was.overrides);
  const auto* scene = std::get_if<Scene>(&as_run);
  if (scene == nullptr) return as_run;
  if (was.shape && shape_of(*scene) != *was.shape)
    return Error{path + ": key 'suture.initial': found " + scene->suture.initial + " with shape " +
                 hex(shape_of(*scene)) + ", allowed the one of the recording, " + hex(*was.shape)};
  if (overrides.empty()) return as_run;
  auto all = was.overrides;
  std::erase_if(
      all, [&](const std::string& o) { return std::ranges::find(overrides, key_of(o), key_of) != overrides.end(); });
  all.insert(all.end(), overrides.begin(), overrides.end());
  return parse_scene(was.text, path, all);
}

}  // namespace ligature::scene
