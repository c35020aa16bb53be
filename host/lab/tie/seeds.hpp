#pragma once
// A range of random seeds, written as N or FIRST-LAST.

#include <charconv>
#include <cstdint>
#include <limits>
#include <string>

#include "host/lab/outcome.hpp"

namespace ligature::lab {

struct Seeds {
  std::uint32_t first = 1, last = 1;
};

/// Parses a range. @throws Refusal
inline Seeds read_seeds(const std::string& text) {
  Seeds s;
  const char* end = text.data() + text.size();
  auto [at, error] = std::from_chars(text.data(), end, s.first);
  s.last = s.first;
  bool good = error == std::errc{};
  if (good && at != end) {
    const auto rest =
        *at == '-' ? std::from_chars(at + 1, end, s.last) : std::from_chars_result{at, std::errc::invalid_argument};
    good = rest.ec == std::errc{} && rest.ptr == end;
  }
  constexpr std::uint32_t kMost = std::numeric_limits<std::uint32_t>::max() - 1;  // loops count one further
  if (!good || s.last < s.first || s.last > kMost || s.last - s.first >= 10'000) {
    throw Refusal("--seeds: found \"" + text + "\", allowed N or FIRST-LAST, rising, up to " + std::to_string(kMost) +
                  ", at most 10000 of them");
  }
  return s;
}

}  // namespace ligature::lab
