#include "host/lab/published/front.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include "host/lab/outcome.hpp"
#include "host/lab/report.hpp"
#include "protocol/scene/csv.hpp"

namespace ligature::published {

using lab::Table, lab::digits;

namespace {
constexpr const char* kFile = "front.csv";
constexpr const char* kColumns = "case,setting,ticks,tick_us,error_tolerances,judged,missed";
}  // namespace

std::vector<Setting> settings_of(const std::string& text, const std::vector<long>& budgets) {
  std::vector<Setting> all;
  if (text == "all") all.push_back({"fast", scene::Accuracy::kFast});
  if (text != "fine") all.push_back({"balanced", scene::Accuracy::kBalanced});
  for (const long work : budgets)
    all.push_back({"balanced " + digits(1e-6 * static_cast<double>(work)) + " M", scene::Accuracy::kBalanced, work});
  if (text != "balanced") all.push_back({"fine", scene::Accuracy::kFine});
  return all;
}

int Outcome::judged() const {
  return static_cast<int>(std::count_if(result.findings.begin(), result.findings.end(), is_judged));
}

int Outcome::missed() const {
  const auto misses = [](const Finding& f) { return !f.holds(); };
  return static_cast<int>(std::count_if(result.findings.begin(), result.findings.end(), misses));
}

double Outcome::worst() const {
  double most = 0.0;
  for (const auto& f : result.findings) {
    if (!is_judged(f) || f.error == 0.0) continue;
    const double ratio = f.tolerance > 0.0 ? f.error / f.tolerance : std::numeric_limits<double>::infinity();
    if (std::isnan(ratio)) return std::numeric_limits<double>::infinity();
    most = std::max(most, ratio);
  }
  return most;
}

std::vector<FrontRow> front_of(const std::vector<Outcome>& outcomes) {
  std::vector<FrontRow> rows;
  for (const auto& o : outcomes) {
    if (o.ticks == 0) continue;
    const auto ticks = static_cast<double>(o.ticks);
    rows.push_back(
        {o.examined->name, o.setting, ticks, o.cpu_us / ticks, o.worst(), double(o.judged()), double(o.missed())});
  }
  return rows;
}

std::vector<Overall> over_all_cases(const std::vector<FrontRow>& rows) {
  std::map<std::string, std::size_t> settings_of_case;
  std::vector<Overall> all;
  const auto of = [&](const std::string& setting) {
    const auto at = std::ranges::find(all, setting, &Overall::setting);
    return at != all.end() ? at : all.insert(all.end(), Overall{.setting = setting});
  };
  for (const auto& r : rows) ++settings_of_case[r.examined], of(r.setting);
  for (const auto& r : rows) {
    if (settings_of_case[r.examined] != all.size()) continue;
    auto& setting = *of(r.setting);
    ++setting.cases, setting.cases_met += r.missed == 0.0;
    setting.judged += r.judged, setting.missed += r.missed;
    setting.tick_us += (r.tick_us - setting.tick_us) / setting.cases;
  }
  for (auto& a : all) {
    a.on_front =
        a.cases > 0.0 && std::ranges::none_of(all, [&](const Overall& b) {
          return b.tick_us <= a.tick_us && b.missed <= a.missed && (b.tick_us < a.tick_us || b.missed < a.missed);
        });
  }
  return all;
}

void print_front(const std::vector<FrontRow>& rows) {
  Table table({"case", "setting", "us a tick", "largest error, tolerances", "judged", "missed"});
  for (const auto& r : rows) table.row({r.examined, r.setting, r.tick_us, r.worst, r.judged, r.missed});
  table.print();
}

void print_overall(const std::vector<Overall>& settings) {
  Table table({"setting, all cases", "us a tick", "cases", "met", "figures judged", "missed", "front"});
  for (const auto& s : settings)
    table.row({s.setting, s.tick_us, s.cases, s.cases_met, s.judged, s.missed, std::string(s.on_front ? "yes" : "")});
  table.print();
}

void write_front(const std::filesystem::path& folder, const std::vector<FrontRow>& rows) {
  Table table({kColumns});
  for (const auto& r : rows) table.row({r.examined, r.setting, r.ticks, r.tick_us, r.worst, r.judged, r.missed});
  table.write(folder / kFile);
  lab::draw("published_front.py", {folder / kFile}, folder / "front.png");
}

void write_overall(const std::filesystem::path& file, const std::vector<Overall>& settings) {
  Table table({"setting", "tick_us", "cases", "cases_met", "judged", "missed", "front"});
  for (const auto& s : settings)
    table.row({s.setting, s.tick_us, s.cases, s.cases_met, s.judged, s.missed, double(s.on_front)});
  table.write(file);
}

std::vector<FrontRow> read_front(const std::filesystem::path& folder) {
  const auto file = folder / kFile;
  const auto read = scene::read_csv(file, kColumns);
  if (const auto* why = std::get_if<scene::Error>(&read)) throw lab::Refusal(why->text);
  std::vector<FrontRow> rows;
  for (const auto& line : std::get<std::vector<scene::CsvRow>>(read)) {
    FrontRow r{.examined = line.cells[0], .setting = line.cells[1]};
    double* const numbers[] = {&r.ticks, &r.tick_us, &r.worst, &r.judged, &r.missed};
    for (std::size_t k = 0; k < std::size(numbers); ++k) {
      const auto& cell = line.cells[k + 2];
      if (numbers[k] == &r.worst && cell == "inf") {
        r.worst = std::numeric_limits<double>::infinity();
      } else if (!scene::parse_number(cell, *numbers[k]) || *numbers[k] < 0.0) {
        throw lab::Refusal(file.string() + ":" + std::to_string(line.line) + ": found '" + scene::shown(cell) +
                           "', allowed a number of 0 or more");
      }
    }
    rows.push_back(std::move(r));
  }
  return rows;
}

}  // namespace ligature::published
