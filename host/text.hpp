#pragma once
#include <string>

namespace ligature::host {

/// printf into a string; the compiler checks the arguments.
[[nodiscard]] [[gnu::format(printf, 1, 2)]] std::string text(const char* format, ...);

}  // namespace ligature::host
