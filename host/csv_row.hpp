#pragma once
#include <charconv>
#include <concepts>
#include <string>
#include <string_view>

namespace ligature::host {

/// Builds one line of CSV. Numbers are written in the shortest form that reads back to the same bits.
class CsvRow {
 public:
  template <class T>
  requires std::integral<T> || std::floating_point<T> CsvRow& add(T value) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
    return add(std::string_view(digits, static_cast<std::size_t>(end - digits)));
  }
  CsvRow& add(std::string_view text) {
    if (!line_.empty()) line_ += ',';
    line_ += text;
    return *this;
  }
  template <class T, std::size_t N>
  CsvRow& add_all(const T (&values)[N]) {
    for (const T& value : values) add(value);
    return *this;
  }

  /// Ends the line and clears the row. @return the line, valid until the next call.
  [[nodiscard]] const std::string& finish() {
    line_ += '\n';
    done_.swap(line_);
    line_.clear();
    return done_;
  }

 private:
  std::string line_, done_;
};

}  // namespace ligature::host
