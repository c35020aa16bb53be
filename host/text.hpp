#pragma once
#include <string>
#include <string_view>

#include "protocol/scene/csv.hpp"

namespace ligature::host {

/// printf into a string; the compiler checks the arguments against the format.
[[nodiscard]] [[gnu::format(printf, 1, 2)]] std::string text(const char* format, ...);

using scene::shortened, scene::shown;

}  // namespace ligature::host
