#include "host/rig_facts.hpp"

#include "host/flight_reader.hpp"
#include "host/log_reader.hpp"

namespace ligature::host {

RigFacts read_rig_facts(const std::string& log_path) {
  if (is_flight_file(log_path)) return FlightReader(log_path).facts();
  LogReader log(log_path);
  while (const LogEvent* event = log.next()) {
    if (event->channel != kStatusChannel) continue;
    if (const auto status = decode<ligature_msg::status_t>(event->data))
      return {status->period_s,   status->max_force_N, true,
              status->scene_file, status->scene_toml,  status->firmware_version};
  }
  return {};
}

}  // namespace ligature::host
