#include "protocol/scene/csv.hpp"

#include <algorithm>

#include "protocol/scene/cells.hpp"
#include "protocol/scene/text_file.hpp"

namespace ligature::scene {
std::string shown(std::string_view text) {
  constexpr std::size_t kMost = 60;
  constexpr std::string_view kHex = "0123456789ABCDEF";
  std::string result;
  for (const char c : text) {
    if (result.size() >= kMost) return result + "..";
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte != 0x7F)
      result += c;
    else
      result.append("\\x").append(1, kHex[byte >> 4U]).append(1, kHex[byte & 15U]);
  }
  return result;
}

std::string shortened(std::string_view text, std::size_t most) {
  constexpr std::string_view kMore = " ..";
  if (text.size() <= most || most < kMore.size()) return std::string(text.substr(0, most));
  const std::string_view head = text.substr(0, most - kMore.size() + 1);  // one more: it may be the blank
  const auto blank = head.rfind(' ');
  return std::string(head.substr(0, blank == head.npos ? head.size() - 1 : blank)) + std::string(kMore);
}

Error at_line(const std::filesystem::path& path, std::size_t line, std::string_view what) {
  return {path.string() + ":" + std::to_string(line) + ": " + std::string(what)};
}

std::variant<std::vector<CsvRow>, Error> read_csv(const std::filesystem::path& path, std::string_view header,
                                                  std::string_view wider, CsvSetting* setting) {
  const auto read = read_text(path, kMostCsv_bytes);
  if (const auto* error = std::get_if<Error>(&read)) return *error;
  std::string_view rest = std::get<std::string>(read);
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);  // byte order mark of UTF-8
  auto columns = split(header);
  std::vector<CsvRow> rows;
  bool header_seen = false;
  for (std::size_t line = 1; !rest.empty(); ++line) {
    const auto text = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), text.size() + 1));
    const auto body = trim(text.substr(0, text.find('#')));
    if (body.empty()) continue;
    const auto cells = split(body);
    const bool may_set = setting != nullptr && !header_seen && setting->line == 0;
    if (may_set && cells.size() == 2 && cells[0] == setting->key) {
      setting->value = cells[1];
      setting->line = line;
    } else if (!header_seen) {
      if (!wider.empty() && cells == split(wider)) header = wider, columns = split(wider);
      if (cells != columns) {
        return at_line(path, line,
                       "found '" + shown(body) + "', allowed the header '" + std::string(header) + "'" +
                           (wider.empty() ? "" : " or '" + std::string(wider) + "'"));
      }
      header_seen = true;
    } else if (cells.size() != columns.size()) {
      return at_line(path, line,
                     "found " + std::to_string(cells.size()) + " columns, allowed " + std::to_string(columns.size()) +
                         " (" + std::string(header) + ")");
    } else if (rows.size() == kMostRows) {
      return at_line(path, line, "found another row, allowed " + std::to_string(kMostRows) + " at most");
    } else {
      rows.push_back({line, {cells.begin(), cells.end()}});
    }
  }
  if (rows.empty())
    return Error{path.string() + ": found no rows, allowed one or more below '" + std::string(header) + "'"};
  return rows;
}

}  // namespace ligature::scene
