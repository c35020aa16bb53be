#include "protocol/scene/csv.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "protocol/scene/cells.hpp"

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

Error at_line(const std::filesystem::path& path, std::size_t line, std::string_view what) {
  return {path.string() + ":" + std::to_string(line) + ": " + std::string(what)};
}

std::variant<std::vector<CsvRow>, Error> read_csv(const std::filesystem::path& path, std::string_view header,
                                                  std::string_view wider) {
  std::ifstream file(path);
  if (!file || std::filesystem::is_directory(path)) {
    return Error{path.string() + ": cannot be read: " + std::strerror(errno ? errno : EISDIR)};
  }
  auto columns = split(header);
  std::vector<CsvRow> rows;
  std::string text;
  bool header_seen = false;
  for (std::size_t line = 1; std::getline(file, text); ++line) {
    if (line == 1 && text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);  // the byte order mark of UTF-8
    const auto body = trim(std::string_view(text).substr(0, text.find('#')));
    if (body.empty()) continue;
    const auto cells = split(body);
    if (!header_seen) {
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
    } else {
      rows.push_back({line, {cells.begin(), cells.end()}});
    }
  }
  if (rows.empty())
    return Error{path.string() + ": found no rows, allowed one or more below '" + std::string(header) + "'"};
  return rows;
}

}  // namespace ligature::scene
