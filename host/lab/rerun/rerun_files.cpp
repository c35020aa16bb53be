#include "host/lab/rerun/rerun_files.hpp"

#include <nlohmann/json.hpp>
#include <system_error>

#include "host/lab/outcome.hpp"
#include "host/tick_statistics.hpp"

namespace ligature::lab {
namespace {

constexpr const char *kLog = "rerun.lcmlog", *kForces = "forces.csv", *kShapes = "shapes.csv";

std::filesystem::path emptied(const std::filesystem::path& folder) {
  make_folder(folder);
  remove_old_outputs(folder, {kLog, kForces, kShapes, "summary.json", "rerun.png"});
  return folder;
}

nlohmann::ordered_json json_of(const Differences::Side& side, std::int64_t ticks) {
  using Json = nlohmann::ordered_json;
  Json knots = Json::array();
  for (const auto& [t_s, type] : side.knots) knots.push_back({t_s, type});
  const auto cost = spread_of(side.cost_us);
  return {{"left_rms_N", side.force[0].rms_N(ticks)},
          {"left_peak_N", side.force[0].peak_N},
          {"right_rms_N", side.force[1].rms_N(ticks)},
          {"right_peak_N", side.force[1].peak_N},
          {"lost_ticks", side.lost_ticks},
          {"tick_us", {{"median", cost.median}, {"p99", cost.p99}, {"max", cost.max}}},
          {"knot_history", knots}};
}

}  // namespace

RerunFiles::RerunFiles(const std::filesystem::path& folder, const std::vector<std::string>& overrides, double period_s)
    : log_((emptied(folder) / kLog).string(), overrides),
      forces_(folder / kForces,
              "t_s,left_recorded_N,left_rerun_N,left_apart_N,right_recorded_N,right_rerun_N,right_apart_N,"
              "time_lost_recorded,time_lost_rerun,cost_recorded_us,cost_rerun_us"),
      shapes_(folder / kShapes, "t_s,rms_m,largest_m"),
      period_s_(period_s) {}

void RerunFiles::add(const ligature_msg::tick_t& recorded, const ligature_msg::tick_t& again,
                     std::optional<double> cost_us) {
  log_.add(again);
  const double cells[] = {static_cast<double>(recorded.tick) * period_s_,
                          host::magnitude(recorded.f_world_N[0]),
                          host::magnitude(again.f_world_N[0]),
                          apart_N(recorded, again, 0),
                          host::magnitude(recorded.f_world_N[1]),
                          host::magnitude(again.f_world_N[1]),
                          apart_N(recorded, again, 1),
                          static_cast<double>(recorded.time_lost),
                          static_cast<double>(again.time_lost),
                          1e-3 * recorded.thread_work_ns,
                          cost_us.value_or(0.0)};
  forces_.row(cells);
}

void RerunFiles::add(const ligature_msg::thread_t& recorded, const ligature_msg::thread_t& again) {
  log_.add(again, recorded.utime);
  const auto off = distance(recorded, again);
  const double cells[] = {static_cast<double>(recorded.tick) * period_s_, off.rms_m, off.largest_m};
  shapes_.row(cells);
}

void RerunFiles::close() {
  log_.close();
  forces_.close();
  shapes_.close();
}

std::function<std::unique_ptr<RerunOutput>(const RecordedRun&)> files_in(const std::filesystem::path& folder,
                                                                         const std::vector<std::string>& overrides) {
  return [folder, overrides](const RecordedRun& run) {
    return std::make_unique<RerunFiles>(folder, overrides, run.period_s);
  };
}

void refuse_own_output(const std::string& log, const std::filesystem::path& folder) {
  std::error_code none;
  if (std::filesystem::equivalent(log, folder / kLog, none))
    throw Refusal("--out " + folder.string() + ": its " + kLog + " is the recording itself; allowed another folder");
}

std::string to_json(const RerunOutcome& o) {
  const auto& d = o.differences;
  const nlohmann::ordered_json json{{"equal", d.are_none()},
                                    {"interrupted", o.interrupted},
                                    {"ticks", d.ticks()},
                                    {"different_ticks", d.different_ticks()},
                                    {"unknown_ticks", o.unknown_ticks},
                                    {"shapes", d.shapes()},
                                    {"different_shapes", d.different_shapes()},
                                    {"first_difference", d.first()},
                                    {"left_apart_rms_N", d.apart()[0].rms_N(d.ticks())},
                                    {"left_apart_peak_N", d.apart()[0].peak_N},
                                    {"right_apart_rms_N", d.apart()[1].rms_N(d.ticks())},
                                    {"right_apart_peak_N", d.apart()[1].peak_N},
                                    {"shape_rms_m", d.shape_rms_m()},
                                    {"shape_largest_m", d.shape_largest_m()},
                                    {"shape_largest_at_s", d.shape_largest_at_s()},
                                    {"recorded", json_of(d.recorded(), d.ticks())},
                                    {"rerun", json_of(d.again(), d.ticks())}};
  return json.dump(1) + "\n";
}

}  // namespace ligature::lab
