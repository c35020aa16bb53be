#pragma once
#include <string>
#include <string_view>

namespace ligature::host {

/// printf into a string; the compiler checks the arguments.
[[nodiscard]] [[gnu::format(printf, 1, 2)]] std::string text(const char* format, ...);

/// Foreign text as it may stand in one line of a message: control characters as \xNN, at most 60 characters.
[[nodiscard]] std::string shown(std::string_view text);

}  // namespace ligature::host
