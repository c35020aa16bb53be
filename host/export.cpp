#include "host/export.hpp"

#include <memory>
#include <vector>

#include "host/console/progress.hpp"
#include "host/errors.hpp"
#include "host/export_hdf5.hpp"
#include "host/export_mcap.hpp"
#include "host/flight_reader.hpp"
#include "host/recording_reader.hpp"
#include "host/rig_facts.hpp"

namespace ligature::host {
namespace {

std::vector<std::unique_ptr<ExportSink>> make_sinks(const ExportTargets& targets, const RigFacts& facts,
                                                    const std::string& source) {
  std::vector<std::unique_ptr<ExportSink>> sinks;
  const auto& [forces, shape, ticks] = targets.csv;
  if (!forces.empty() || !shape.empty() || !ticks.empty()) sinks.push_back(make_csv_sink(targets.csv, facts, source));
  if (!targets.hdf5.empty()) sinks.push_back(make_hdf5_sink(targets.hdf5, facts, source));
  if (!targets.mcap.empty()) sinks.push_back(make_mcap_sink(targets.mcap, facts, source));
  if (!targets.trace.path.empty()) sinks.push_back(make_trace_sink(targets.trace, facts, source));
  return sinks;
}

}  // namespace

ExportResult export_recording(const std::string& log_path, const ExportTargets& targets) {
  const bool is_flight = is_flight_file(log_path);
  if (is_flight && !targets.csv.shape.empty())
    throw BadInput(log_path +
                   ": a flight recorder file holds no shapes; allowed --forces, --ticks, --hdf5, --mcap, --trace");
  const RigFacts facts = read_rig_facts(log_path);
  const auto sinks = make_sinks(targets, facts, log_path);
  std::vector<ExportSink*> each;
  each.reserve(sinks.size());
  for (const auto& sink : sinks) each.push_back(sink.get());
  console::Progress progress("export");
  ExportResult result = read_recording(log_path, facts, each, &progress);
  for (const auto* sink : each) sink->check();
  for (auto* sink : each) sink->commit();
  return result;
}

}  // namespace ligature::host
