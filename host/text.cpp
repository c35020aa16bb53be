#include "host/text.hpp"

#include <cstdarg>
#include <cstdio>

namespace ligature::host {

std::string text(const char* format, ...) {
  va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  std::string result(static_cast<std::size_t>(std::vsnprintf(nullptr, 0, format, arguments)), '\0');
  std::vsnprintf(result.data(), result.size() + 1, format, again);
  va_end(again);
  va_end(arguments);
  return result;
}

std::string shown(std::string_view foreign) {
  constexpr std::size_t kMost = 60;
  std::string result;
  for (const char c : foreign) {
    if (result.size() >= kMost) return result + "..";
    const auto byte = static_cast<unsigned char>(c);
    result += byte < 0x20 || byte == 0x7F ? text("\\x%02X", unsigned{byte}) : std::string(1, c);
  }
  return result;
}

}  // namespace ligature::host
