#include "protocol/scene/toml_text.hpp"

#include <algorithm>

#include "protocol/scene/text_file.hpp"

namespace ligature::scene {
namespace {

/// Length of the quotation mark at the start of `rest`: 3 for a multi-line string, else 1.
std::size_t quote_at(std::string_view rest) {
  return rest.size() >= 3 && rest[1] == rest[0] && rest[2] == rest[0] ? 3 : 1;
}

/// Length of the quoted string at the start of `rest`, quotation marks included. An unterminated string ends where the
/// parser stops: at the line's end, or at the text's end if it is a multi-line string.
std::size_t quoted(std::string_view rest) {
  const auto quote = rest.substr(0, quote_at(rest));
  for (std::size_t i = quote.size(); i < rest.size(); ++i) {
    if (rest[i] == '\\' && quote[0] == '"') {
      ++i;
    } else if (rest.substr(i).starts_with(quote)) {
      return i + quote.size();
    } else if (rest[i] == '\n' && quote.size() == 1) {
      return i;
    }
  }
  return rest.size();
}

}  // namespace

int line_of_stray_character(std::string_view text) {
  const auto is_stray = [](char c) { return static_cast<unsigned char>(c) > 0x7F; };
  std::size_t i = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;  // a byte order mark is allowed
  while (i < text.size()) {
    if (text[i] == '#') {
      i = std::min(text.find('\n', i), text.size());
      continue;
    }
    const auto piece = text.substr(i, text[i] == '"' || text[i] == '\'' ? quoted(text.substr(i)) : 1);
    if (const auto stray = std::find_if(piece.begin(), piece.end(), is_stray); stray != piece.end()) {
      return 1 + static_cast<int>(std::count(text.begin(), stray, '\n'));
    }
    i += piece.size();
  }
  return 0;
}

int line_too_deep(std::string_view text) {
  std::size_t dots = 0, open = 0;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '#') {
      i = std::min(text.find('\n', i), text.size());
      continue;
    }
    if (c == '[' || c == '{') ++open;
    if ((c == ']' || c == '}') && open > 0) --open;
    if (std::string_view("=,[]{}\n").find(c) != std::string_view::npos) dots = 0;
    if (c == '.') ++dots;
    if (dots > kDeepest || open > kDeepest)
      return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(i), '\n'));
    i += c == '"' || c == '\'' ? quoted(text.substr(i)) : 1;
  }
  return 0;
}

std::variant<toml::table, Error> parse_toml(const std::string& text, const std::string& name) {
  if (const int line = line_too_deep(text); line > 0) {
    return Error{name + ":" + std::to_string(line) + ": nested too deep, allowed " + std::to_string(kDeepest) +
                 " dots in a key and as many brackets in one another"};
  }
  if (const int line = line_of_stray_character(text); line > 0) {
    return Error{name + ":" + std::to_string(line) +
                 ": a character outside ASCII, allowed in comments; in quotes write \\u00e9 for it"};
  }
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& e) {
    return Error{name + ":" + std::to_string(e.source().begin.line) + ": not TOML: " + std::string(e.description())};
  }
}

std::variant<toml::table, Error> parse_toml_file(const std::filesystem::path& path) {
  const auto read = read_text(path, kMostScene_bytes);
  if (const auto* error = std::get_if<Error>(&read)) return *error;
  return parse_toml(std::get<std::string>(read), path.string());
}

}  // namespace ligature::scene
