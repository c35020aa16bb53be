#include "host/polyline_file.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>

#include "host/errors.hpp"
#include "host/log_reader.hpp"
#include "host/rig_facts.hpp"
#include "host/text.hpp"
#include "protocol/scene/cells.hpp"

namespace ligature::host {
namespace {

// UTF-8 byte order mark; spreadsheets write it at the start
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::size_t kMostBytes = 64U << 20;    // largest input: a pipe may never end
constexpr std::string_view kBlanks = " \t\r\"";  // quotation marks included: spreadsheets may quote fields

std::optional<double> number(std::string_view field) {
  double value = 0.0;
  return scene::parse_number(field, value) ? std::optional(value) : std::nullopt;
}

/// Replaces the separator by commas. Columns may be separated by commas, semicolons, or blanks and tabs; the first of
/// these that occurs in the line is taken as the separator.
std::string comma_separated(std::string_view line) {
  std::string text(line);
  if (text.find(',') != std::string::npos) return text;
  if (text.find(';') != std::string::npos) {
    std::ranges::replace(text, ';', ',');
    return text;
  }
  std::string joined;
  for (std::istringstream words(text); words >> text;) joined += (joined.empty() ? "" : ",") + text;
  return joined;
}

std::string with_commas(const std::vector<std::string_view>& words) {
  std::string joined;
  for (const auto& word : words) joined += (joined.empty() ? "" : ",") + std::string(word);
  return joined;
}

std::string lower(std::string_view word) {
  std::string result(word);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

/// Index of each column; -1: absent.
struct Columns {
  int x = 0, y = 1, z = 2, time = -1, node = -1, count = 3;
};

class PolylineReader {
 public:
  PolylineReader(const std::string& path, std::optional<double> at_s) : path_(path), at_s_(at_s) {}

  void take(std::string_view line) {
    if (++line_number_ == 1 && line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
    if (const auto comment = line.find('#'); comment != std::string_view::npos) line = line.substr(0, comment);
    if (scene::trim(line, kBlanks).empty()) return;
    const std::string text = comma_separated(line);
    const auto fields = scene::split(text, kBlanks);
    if (!columns_) {
      const bool has_header = !number(fields.front());
      const bool is_numbered = !has_header && fields.size() == 4;  // columns: number, x, y, z
      columns_ = has_header ? columns_of(fields) : is_numbered ? Columns{1, 2, 3, -1, -1, 4} : Columns{};
      if (has_header) return;
    }
    take_row(fields);
  }

  /// Handles a last line without a line end. When the writer of a file with shapes was killed, that line can be an
  /// incomplete row.
  void take_unended(std::string_view line) {
    const bool half_a_row = columns_ && columns_->node >= 0 && !scene::trim(line, kBlanks).empty() &&
                            std::ranges::count(line, ',') + 1 < columns_->count;
    half_a_row ? void(row_cut_off_ = true) : take(line);
  }

  Polyline finish() {
    // All shapes of one thread have equally many nodes: a shorter last shape is incomplete, because its writer was
    // killed.
    const bool cut_off = row_cut_off_ || (columns_ && columns_->node >= 0 && current_.points.size() < whole_nodes_);
    if (cut_off && chosen_.points.empty()) throw BadInput(path_ + ": its only shape is cut off; allowed: a whole one");
    if (!cut_off) choose();
    chosen_.last_is_cut_off = cut_off;
    if (chosen_.points.size() < 3)
      throw BadInput(path_ + ": found " + std::to_string(chosen_.points.size()) + " points, allowed 3 or more");
    return std::move(chosen_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw BadInput(path_ + ":" + std::to_string(line_number_) + ": " + what);
  }

  Columns columns_of(const std::vector<std::string_view>& names) const {
    Columns found{-1, -1, -1, -1, -1, static_cast<int>(names.size())};
    for (int i = 0; i < found.count; ++i) {
      const std::string name = lower(names[static_cast<std::size_t>(i)]);
      const auto take = [&](int& column) {
        if (column >= 0)
          refuse("header '" + shown(with_commas(names)) + "' has two columns for '" + name + "', allowed one");
        column = i;
      };
      if (name == "x" || name == "x_m") take(found.x);
      if (name == "y" || name == "y_m") take(found.y);
      if (name == "z" || name == "z_m") take(found.z);
      if (name == "t_s" || name == "time") take(found.time);
      if (name == "node") take(found.node);
    }
    if (found.x < 0 || found.y < 0 || found.z < 0)
      refuse("header '" + shown(with_commas(names)) +
             "' lacks a coordinate, allowed columns x,y,z or x_m,y_m,z_m (and t_s, node)");
    return found;
  }

  double value(const std::vector<std::string_view>& fields, int column) const {
    const auto field = fields[static_cast<std::size_t>(column)];
    const auto parsed = number(field);
    if (!parsed) refuse("found '" + shown(field) + "', allowed a finite number");
    return *parsed;
  }

  void take_row(const std::vector<std::string_view>& fields) {
    const Columns& columns = columns_.value();
    if (static_cast<int>(fields.size()) != columns.count)
      refuse("found " + std::to_string(fields.size()) + " fields, allowed " + std::to_string(columns.count));
    const std::array<double, 3> point{value(fields, columns.x), value(fields, columns.y), value(fields, columns.z)};
    if (columns.time >= 0) {
      const double time_s = value(fields, columns.time);
      if (current_.time_s != time_s) {
        choose();
        current_ = {{}, time_s};
      }
    }
    if (columns.node >= 0 && value(fields, columns.node) != static_cast<double>(current_.points.size()))
      refuse("found node " + shown(fields[static_cast<std::size_t>(columns.node)]) + ", allowed " +
             std::to_string(current_.points.size()) + " (nodes rise by one from 0)");
    current_.points.push_back(point);
  }

  /// Keeps the shape just read when it fits `at_s` better than the one kept so far; without `at_s`, always.
  void choose() {
    if (current_.points.empty()) return;
    whole_nodes_ = current_.points.size();
    const bool is_better =
        !at_s_ || !chosen_.time_s || std::abs(current_.time_s.value() - *at_s_) < std::abs(*chosen_.time_s - *at_s_);
    if (is_better) chosen_ = current_;
  }

  std::string path_;
  std::optional<double> at_s_;
  int line_number_ = 0;
  std::optional<Columns> columns_;
  Polyline current_, chosen_;
  std::size_t whole_nodes_ = 0;  // number of nodes of the last complete shape
  bool row_cut_off_ = false;
};

void refuse_what_is_no_text(const std::string& path) {
  std::error_code none;
  const auto found = std::filesystem::status(path, none);
  if (std::filesystem::is_directory(found)) throw BadInput(path + ": is a folder; allowed: a file");
  if (std::filesystem::is_character_file(found) || std::filesystem::is_block_file(found))
    throw BadInput(path + ": is a device; allowed: a file or a pipe");
}

/// std::getline() with at most `most` characters, because a line from a pipe may never end.
bool bounded_line(std::istream& in, std::string& line, std::size_t most) {
  line.clear();
  for (int c; line.size() < most && (c = in.get()) != std::istream::traits_type::eof();) {
    if (c == '\n') return true;
    line += static_cast<char>(c);
  }
  return !line.empty();
}

}  // namespace

Polyline read_polyline_csv(const std::string& path, std::optional<double> at_s) {
  refuse_what_is_no_text(path);
  std::ifstream file(path);
  if (!file) throw BadInput(path + ": " + std::strerror(errno));
  PolylineReader reader(path, at_s);
  std::size_t bytes = 0;
  for (std::string line; bounded_line(file, line, kMostBytes - bytes);) {
    bytes += line.size() + 1;
    if (bytes >= kMostBytes) throw BadInput(path + ": found more than 64 MB, allowed at most that");
    file.eof() ? reader.take_unended(line) : reader.take(line);
  }
  return reader.finish();
}

Polyline read_polyline_log(const std::string& path, std::optional<double> at_s) {
  const RigFacts facts = read_rig_facts(path);
  LogReader log(path);
  Polyline chosen;
  while (const LogEvent* event = log.next()) {
    if (event->channel != kThreadChannel) continue;
    const auto thread = decode<ligature_msg::thread_t>(event->data);
    if (!thread) continue;
    const double time_s = facts.time_s(thread->tick);
    if (at_s && chosen.time_s && std::abs(time_s - *at_s) >= std::abs(*chosen.time_s - *at_s)) continue;
    chosen = {{}, time_s};
    chosen.radius_m = thread->radius_m;
    for (const auto& p : thread->p_W_m) chosen.points.push_back({p[0], p[1], p[2]});
  }
  chosen.damage = log.damage();
  if (chosen.points.size() < 3)
    throw BadInput(path + ": holds no thread of 3 or more nodes; allowed: a log with messages on " +
                   std::string(kThreadChannel));
  return chosen;
}

bool is_lcm_log(const std::string& path) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(path, none)) return false;  // reading from a pipe would consume its first bytes
  std::ifstream file(path, std::ios::binary);
  char start[4] = {};
  return file.read(start, 4) && std::string_view(start, 4) == "\xED\xA1\xDA\x01";
}

}  // namespace ligature::host
