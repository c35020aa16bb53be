#include "host/knot_command.hpp"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "host/damage_notice.hpp"
#include "host/errors.hpp"
#include "host/knot/common_name.hpp"
#include "host/knot/recognise.hpp"
#include "host/polyline_file.hpp"
#include "host/text.hpp"

namespace ligature::host {
namespace {

constexpr double kAtWithin_s = 1.0;  // --at takes the nearest shape, unless it is further away

std::string json_line(const knot::KnotResult& found) {
  nlohmann::ordered_json json = {
      {"type", found.type}, {"handedness", found.handedness}, {"determinant", nullptr}, {"alexander", nullptr}};
  if (!found.alexander.empty()) {  // else it could not be computed
    json["determinant"] = found.determinant;
    json["alexander"] = found.alexander;
  }
  const auto common = knot::common_name(found.type, found.handedness);
  json["common_name"] = common.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(common);
  json["candidates"] = found.candidates;
  return json.dump() + "\n";
}

std::string words(const knot::KnotResult& found, const Polyline& line) {
  std::string result = knot::full_name(found.type, found.handedness);
  for (std::size_t k = 0; k < found.candidates.size(); ++k)
    result += (k == 0 ? ", candidates: " : ", ") + found.candidates[k];
  if (found.alexander.empty())
    result += "  (no invariant could be computed";
  else
    result += text("  (determinant %d, Alexander polynomial", found.determinant);
  for (const int coefficient : found.alexander) result += text(" %d", coefficient);
  result += text("; %zu points", line.points.size());
  if (line.time_s) result += text(" at %.3f s", *line.time_s);
  return result + ")\n";
}

}  // namespace

std::string describe_knot(const KnotOptions& options) {
  Polyline line = is_lcm_log(options.file) ? read_polyline_log(options.file, options.at_s)
                                           : read_polyline_csv(options.file, options.at_s);
  if (options.at_s && !line.time_s) throw BadInput(options.file + ": --at needs a column t_s, found none");
  if (options.at_s && std::abs(*line.time_s - *options.at_s) > kAtWithin_s)
    throw BadInput(options.file + text(": --at: found %g s, the nearest shape is at %.3f s; allowed up to %g s from it",
                                       *options.at_s, *line.time_s, kAtWithin_s));
  tell_damage(options.file, line.damage);
  if (line.last_is_cut_off)
    std::fprintf(stderr, "ligature-host: %s: the last shape is cut off; took %s whole one\n", options.file.c_str(),
                 options.at_s ? "the nearest" : "the last");
  const bool ends_meet = line.points.front() == line.points.back();
  const bool closed = options.closed || (!options.open && ends_meet);
  if (closed && ends_meet) line.points.pop_back();
  if (line.points.size() < 3)
    throw BadInput(options.file + ": found " + std::to_string(line.points.size()) +
                   " points beside the one that closes it, allowed 3 or more");
  const knot::KnotResult found = knot::recognise(line.points, closed);
  return options.json ? json_line(found) : words(found, line);
}

}  // namespace ligature::host
