#include "firmware/app/doctor/report.hpp"

#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

namespace ligature::app {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* kFormat = "ligature doctor 1";
constexpr std::array<const char*, 3> kGrades{"OK", "WARN", "FAIL"};

Json json_of(const LatencyHistogram& histogram) {
  Json bins = Json::array();
  for (std::size_t i = 0; i < histogram.bins().size(); ++i)
    if (histogram.bins()[i] > 0) bins.push_back({i, histogram.bins()[i]});
  return {{"count", histogram.count()},
          {"bins_us", std::move(bins)},
          {"over_10_ms", histogram.over()},
          {"p50_us", histogram.quantile_us(0.5)},
          {"p99_us", histogram.quantile_us(0.99)},
          {"p99.9_us", histogram.quantile_us(0.999)},
          {"p99.99_us", histogram.quantile_us(0.9999)},
          {"max_us", histogram.max_us()}};
}

LatencyHistogram histogram_of(const Json& json) {
  LatencyHistogram histogram;
  for (const auto& bin : json.at("bins_us"))
    histogram.restore(bin.at(0).get<std::size_t>(), bin.at(1).get<std::uint64_t>());
  histogram.restore_rest(json.at("over_10_ms").get<std::uint64_t>(), json.at("max_us").get<double>());
  return histogram;
}

DoctorReport read(const Json& json) {
  DoctorReport r;
  r.started = json.at("started").get<std::string>();
  const Json& machine = json.at("machine");
  r.kernel = machine.at("kernel").get<std::string>();
  r.cpu = machine.at("cpu").get<std::string>();
  r.cores = machine.at("cores").get<int>();
  r.core = machine.at("core_of_the_loop").get<int>();
  r.ligature = json.at("ligature").get<std::string>();
  r.seconds = json.at("seconds").get<double>();
  r.load = json.at("load").get<std::vector<std::string>>();
  r.scene = json.at("scene").get<std::string>();
  if (!json.at("slack_us").is_null()) r.slack_us = json.at("slack_us").get<double>();
  r.hardware = json.at("hardware").get<std::string>();
  r.wakeup = histogram_of(json.at("wakeup"));
  for (const auto& late : json.at("worst"))
    r.worst.push_back({late.at("at_s").get<double>(), late.at("late_us").get<double>()});
  for (const auto& check : json.at("checks")) {
    const auto grade = std::ranges::find(kGrades, check.at("grade").get<std::string>()) - kGrades.begin();
    r.checks.push_back({static_cast<platform::Grade>(std::min<std::ptrdiff_t>(grade, 2)),
                        check.at("what").get<std::string>(), check.at("found").get<std::string>(),
                        check.at("remedy").get<std::string>()});
  }
  for (const auto& can : json.at("can"))
    r.can.push_back({can.at("interface").get<std::string>(), histogram_of(can.at("round_trips")),
                     can.at("lost").get<std::uint64_t>(), can.at("problem").get<std::string>()});
  r.verdict = json.at("verdict").get<std::string>();
  return r;
}

std::string row(const char* what, const std::string& a, const std::string& b) {
  char text[512];
  std::snprintf(text, sizeof text, "%-24s %-34s %s%s\n", what, a.c_str(), b.c_str(), a == b ? "" : "   *");
  return text;
}

std::string number(double value, const char* unit) {
  char text[64];
  std::snprintf(text, sizeof text, "%.4g %s", value, unit);
  return text;
}

std::string words(const std::vector<std::string>& parts) {
  std::string all;
  for (const auto& part : parts) all += (all.empty() ? "" : ", ") + part;
  return all.empty() ? "none" : all;
}

/// How many of a million wake-ups came at least `us` microseconds late.
std::string share(const DoctorReport& r, double us) {
  const auto count = static_cast<double>(r.wakeup.count());
  return number(count > 0 ? 1e6 * static_cast<double>(r.wakeup.from(us)) / count : 0.0, "a million");
}

/// What both reports say in their n-th row of one name; rows come in the order of `a`, then those that only `b` has.
std::string rows_of_checks(const DoctorReport& a, const DoctorReport& b) {
  struct Row {
    std::string what;
    std::array<std::string, 2> found{"not checked", "not checked"};
  };
  std::vector<Row> rows;
  for (std::size_t side = 0; side < 2; ++side) {
    std::map<std::string, std::size_t> seen;  // rows of a name so far
    for (const auto& check : (side == 0 ? a : b).checks) {
      std::size_t nth = seen[check.what]++;
      const auto is_its_row = [&](const Row& row) { return row.what == check.what && nth-- == 0; };
      auto place = side == 0 ? rows.end() : std::ranges::find_if(rows, is_its_row);
      if (place == rows.end()) place = rows.insert(rows.end(), Row{check.what});
      place->found[side] = std::string(kGrades[static_cast<std::size_t>(check.grade)]) + " " + check.found;
    }
  }
  std::string text;
  for (const Row& each : rows) text += row(each.what.c_str(), each.found[0], each.found[1]);
  return text;
}

std::string scene_of(const DoctorReport& r) {
  return r.scene.empty() ? "none" : r.scene + (r.slack_us ? ", leaves " + number(*r.slack_us, "us") : "");
}

}  // namespace

std::string to_json(const DoctorReport& r) {
  Json checks = Json::array(), worst = Json::array(), can = Json::array();
  for (const auto& c : r.checks)
    checks.push_back({{"grade", kGrades[static_cast<std::size_t>(c.grade)]},
                      {"what", c.what},
                      {"found", c.found},
                      {"remedy", c.remedy}});
  for (const auto& late : r.worst) worst.push_back({{"at_s", late.at_s}, {"late_us", late.late_us}});
  for (const auto& echo : r.can)
    can.push_back({{"interface", echo.interface},
                   {"round_trips", json_of(echo.round_trips)},
                   {"lost", echo.lost},
                   {"problem", echo.problem}});
  const Json machine{{"kernel", r.kernel}, {"cpu", r.cpu}, {"cores", r.cores}, {"core_of_the_loop", r.core}};
  const Json json{{"format", kFormat},
                  {"ligature", r.ligature},
                  {"started", r.started},
                  {"verdict", r.verdict},
                  {"machine", machine},
                  {"seconds", r.seconds},
                  {"load", r.load},
                  {"scene", r.scene},
                  {"slack_us", r.slack_us ? Json(*r.slack_us) : Json()},
                  {"hardware", r.hardware},
                  {"checks", std::move(checks)},
                  {"wakeup", json_of(r.wakeup)},
                  {"worst", std::move(worst)},
                  {"can", std::move(can)}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::variant<DoctorReport, std::string> report_of(const std::string& text) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || json.value("format", Json()) != kFormat)
    return std::string("found no report of 'ligature-firmware doctor --report'");
  try {
    return read(json);
  } catch (const Json::exception& error) {
    return std::string("damaged report: ") + error.what();
  }
}

std::string compare(const DoctorReport& a, const std::string& name_a, const DoctorReport& b,
                    const std::string& name_b) {
  std::string text =
      row("", name_a, name_b) + row("started", a.started, b.started) + row("kernel", a.kernel, b.kernel) +
      row("cpu", a.cpu, b.cpu) + row("ligature", a.ligature, b.ligature) +
      row("measured", number(a.seconds, "s"), number(b.seconds, "s")) + row("load", words(a.load), words(b.load)) +
      row("scene", scene_of(a), scene_of(b)) + rows_of_checks(a, b);
  for (const auto& [name, q] :
       {std::pair{"wake-up p50", 0.5}, {"wake-up p99", 0.99}, {"wake-up p99.9", 0.999}, {"wake-up p99.99", 0.9999}})
    text += row(name, number(a.wakeup.quantile_us(q), "us"), number(b.wakeup.quantile_us(q), "us"));
  text += row("wake-up worst", number(a.wakeup.max_us(), "us"), number(b.wakeup.max_us(), "us")) +
          row("100 us or later", share(a, 100.0), share(b, 100.0)) +
          row("300 us or later", share(a, 300.0), share(b, 300.0));
  for (const auto& mine : a.can)
    for (const auto& other : b.can)
      if (mine.interface == other.interface)
        text +=
            row((mine.interface + " round trip").c_str(),
                number(mine.round_trips.quantile_us(0.5), "us, ") + number(mine.round_trips.max_us(), "us at most"),
                number(other.round_trips.quantile_us(0.5), "us, ") + number(other.round_trips.max_us(), "us at most"));
  return text + row("verdict", a.verdict, b.verdict) + "* differs\n";
}

}  // namespace ligature::app
