#include "host/lab/fit/measurement.hpp"

#include <algorithm>
#include <set>
#include <variant>

#include "host/lab/outcome.hpp"
#include "host/lab/report.hpp"
#include "protocol/scene/csv.hpp"
#include "protocol/scene/text_file.hpp"

namespace ligature::fit {
namespace {

using lab::Refusal;

const Law& law_of(const std::filesystem::path& path) {
  const auto read = scene::read_text(path, scene::kMostCsv_bytes);
  if (const auto* error = std::get_if<scene::Error>(&read)) throw Refusal(error->text);
  std::string_view rest = std::get<std::string>(read);
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);  // byte order mark of UTF-8
  std::string headers;
  for (const auto& law : laws()) headers += std::string(headers.empty() ? "'" : ", '") + law.header + "'";
  for (std::size_t line = 1; !rest.empty(); ++line) {
    const auto text = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), text.size() + 1));
    const auto body = scene::trim(text.substr(0, text.find('#')));
    if (body.empty()) continue;
    for (const auto& law : laws()) {
      if (scene::split(body) == scene::split(law.header)) return law;
    }
    throw Refusal(
        scene::at_line(path, line, "found '" + scene::shown(body) + "', allowed one of the headers " + headers).text);
  }
  throw Refusal(path.string() + ": found no line, allowed one of the headers " + headers);
}

std::vector<double> numbers(const std::filesystem::path& path, const Law& law, const scene::CsvRow& row) {
  std::vector<double> values;
  const auto refuse = [&](const std::string& why) { throw Refusal(scene::at_line(path, row.line, why).text); };
  for (std::size_t k = 0; k < law.columns.size(); ++k) {
    const auto& [name, least, most] = law.columns[k];
    double value = 0.0;
    if (!scene::parse_number(row.cells[k], value) || value < least || value > most) {
      refuse("column '" + std::string(name) + "': found '" + scene::shown(row.cells[k]) + "', allowed " +
             lab::digits(least) + " .. " + lab::digits(most));
    }
    values.push_back(value);
  }
  if (const auto why = law.refused(values); !why.empty()) refuse(why);
  return values;
}

/// Number of different values in the first column of all measurements of a law.
std::size_t different(const std::vector<Measurement>& all, const Law& law) {
  std::set<double> seen;
  for (const auto& m : all) {
    for (const auto& row : m.rows) {
      if (m.law == &law) seen.insert(row.front());
    }
  }
  return seen.size();
}

}  // namespace

Measurement read_measurement(const std::filesystem::path& path) {
  const Law& law = law_of(path);
  const auto read = scene::read_csv(path, law.header);
  if (const auto* error = std::get_if<scene::Error>(&read)) throw Refusal(error->text);
  Measurement m{&law, path.string(), {}};
  for (const auto& row : std::get<std::vector<scene::CsvRow>>(read)) m.rows.push_back(numbers(path, law, row));
  return m;
}

void check_enough(const std::vector<Measurement>& all) {
  std::set<Parameter> found;
  for (const auto& m : all) found.insert(m.law->finds.begin(), m.law->finds.end());
  for (const auto& m : all) {
    for (const auto needed : m.law->needs) {
      if (found.contains(needed)) continue;
      throw Refusal(m.file + ": found no file that tells " + kTold[needed].name +
                    ", allowed only beside one with the header 'length_m,mass_kg'");
    }
    const std::size_t least = m.law->finds.size() > 1 ? 2 : 1, seen = different(all, *m.law);
    if (seen < least) {
      throw Refusal(m.file + ": found one " + m.law->columns.front().name + ", allowed 2 or more different ones");
    }
    std::size_t rows = 0;
    for (const auto& other : all) rows += other.law == m.law ? other.rows.size() : 0;
    if (rows < m.law->least_rows) {
      throw Refusal(m.file + ": found " + std::to_string(rows) + " rows, allowed " + std::to_string(m.law->least_rows) +
                    " or more");
    }
  }
}

}  // namespace ligature::fit
