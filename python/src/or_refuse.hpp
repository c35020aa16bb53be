#pragma once
#include <string>
#include <utility>
#include <variant>

#include "host/lab/outcome.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::python {

/// Returns what was read. @throws lab::Refusal with the reader's one-line error.
template <class T>
[[nodiscard]] T or_refuse(std::variant<T, scene::Error> read) {
  if (const auto* error = std::get_if<scene::Error>(&read)) throw lab::Refusal(error->text);
  return std::get<T>(std::move(read));
}

}  // namespace ligature::python
