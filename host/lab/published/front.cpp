#include "host/lab/published/front.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/lab/report.hpp"

namespace ligature::published {

using lab::Cell, lab::Table, lab::digits;

std::vector<Setting> settings_of(const std::string& text, const std::vector<long>& budgets) {
  std::vector<Setting> all;
  if (text == "all") all.push_back({"fast", scene::Accuracy::kFast});
  if (text != "fine") all.push_back({"balanced", scene::Accuracy::kBalanced});
  for (const long work : budgets)
    all.push_back({"balanced, " + digits(1e-6 * static_cast<double>(work)) + " M", scene::Accuracy::kBalanced, work});
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
    most = std::max(most, std::isnan(ratio) ? std::numeric_limits<double>::infinity() : ratio);
  }
  return most;
}

void print_front(const std::vector<Outcome>& outcomes) {
  Table table({"case", "setting", "us a tick", "largest error, tolerances", "judged", "missed"});
  for (const auto& o : outcomes) {
    if (o.ticks == 0) continue;
    table.row({std::string(o.examined->name), o.setting, o.cpu_us / static_cast<double>(o.ticks), o.worst(),
               double(o.judged()), double(o.missed())});
  }
  table.print();
}

void write_front(const std::filesystem::path& folder, const std::vector<Outcome>& outcomes) {
  Table table({"case", "setting", "ticks", "tick_us", "error_tolerances", "judged", "missed"});
  for (const auto& o : outcomes) {
    if (o.ticks == 0) continue;
    table.row({std::string(o.examined->name), o.setting, double(o.ticks), o.cpu_us / static_cast<double>(o.ticks),
               o.worst(), double(o.judged()), double(o.missed())});
  }
  table.write(folder / "front.csv");
  lab::draw("published_front.py", {folder / "front.csv"}, folder / "front.png");
}

}  // namespace ligature::published
