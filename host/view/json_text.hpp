#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace ligature::host::view {

/// A text field of a page's message; empty when there is none or it is no text.
[[nodiscard]] inline std::string text_of(const nlohmann::json& message, const char* key) {
  const auto found = message.find(key);
  return found != message.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// The field "id": the number that a page gave to its request; null when it is absent or no number.
[[nodiscard]] inline nlohmann::json id_of(const nlohmann::json& message) {
  const auto found = message.find("id");
  return found != message.end() && found->is_number() ? *found : nlohmann::json(nullptr);
}

}  // namespace ligature::host::view
