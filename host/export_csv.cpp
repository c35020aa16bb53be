#include "host/export_csv.hpp"

#include <memory>
#include <optional>

#include "host/atomic_file.hpp"
#include "host/csv_tables.hpp"
#include "host/errors.hpp"
#include "host/flight_reader.hpp"
#include "host/log_reader.hpp"
#include "host/rig_facts.hpp"
#include "host/session_tally.hpp"
#include "host/stop_signal.hpp"
#include "host/tick_order.hpp"

namespace ligature::host {
namespace {

std::unique_ptr<AtomicFile> open_table(const std::string& path, const std::string& header) {
  if (path.empty()) return nullptr;
  auto file = std::make_unique<AtomicFile>(path);
  file->write(header);
  return file;
}

class Exporter {
 public:
  Exporter(RigFacts facts, const ExportTargets& targets)
      : facts_(std::move(facts)),
        forces_(open_table(targets.forces, forces_header())),
        shape_(open_table(targets.shape, shape_header())),
        ticks_(open_table(targets.ticks, ticks_header())) {}

  void take(const LogEvent& event) {
    if (event.channel == kTicksChannel) {
      if (const auto batch = decode<ligature_msg::tick_batch_t>(event.data)) return take(*batch);
    } else if (event.channel == kThreadChannel) {
      if (const auto thread = decode<ligature_msg::thread_t>(event.data)) return take(*thread);
    } else if (is_readable(event.channel, event.data)) {
      return;
    }
    ++result_.unreadable_messages;
  }

  void take(const ligature_msg::tick_batch_t& batch) {
    const int session = tally_.find_or_add(batch.session);
    if (session < 0) {
      ++result_.unreadable_messages;
      return;
    }
    if (session != session_) end_session();
    session_ = session;
    for (const auto& tick : batch.ticks) {
      if (tally_[session].ticks.add(tick.tick))
        order_.add(tick, [this](const auto& t) { write(t); });
      else
        ++result_.duplicates_left_out;
    }
  }

  ExportResult commit() {
    end_session();
    name_missing();
    for (auto* table : {forces_.get(), shape_.get(), ticks_.get()})
      if (table) table->commit();
    return result_;
  }

  [[nodiscard]] bool has_ticks() const { return tally_.received() > 0; }

 private:
  void end_session() {
    order_.flush([this](const auto& t) { write(t); });
  }

  void write(const ligature_msg::tick_t& tick) {
    ++result_.tick_rows;
    if (forces_) forces_->write(forces_row(row_, tick, facts_.time_s(tick.tick), session_ + 1));
    if (ticks_) ticks_->write(ticks_row(row_, tick, facts_.time_s(tick.tick), session_ + 1));
  }

  void name_missing() {
    constexpr std::size_t kNamed = 10;
    std::size_t named = 0;
    for (const Session& session : tally_.sessions()) {
      result_.missing += session.ticks.missing();
      for (const TickRange& hole : session.ticks.missing_ranges()) {
        if (++named > kNamed) break;
        if (named > 1) result_.missing_ticks += ", ";
        result_.missing_ticks += std::to_string(hole.first);
        if (hole.size() > 1) result_.missing_ticks += ".." + std::to_string(hole.last);
      }
    }
    if (named > kNamed) result_.missing_ticks += ", ..";
  }

  void take(const ligature_msg::thread_t& thread) {
    ++result_.shapes;
    if (!shape_) return;
    for (int node = 0; node < thread.count; ++node)
      shape_->write(shape_row(row_, thread, facts_.time_s(thread.tick), node));
  }

  RigFacts facts_;
  std::unique_ptr<AtomicFile> forces_, shape_, ticks_;
  SessionTally tally_;
  TickOrder order_;
  int session_ = -1;
  CsvRow row_;
  ExportResult result_;
};

/// A flight recorder's file: one session, ticks only.
ExportResult export_flight(const std::string& path, const ExportTargets& targets) {
  if (!targets.shape.empty())
    throw BadInput(path + ": a flight recorder file holds no shapes; allowed --forces, --ticks");
  const FlightReader recorder(path);
  if (recorder.ticks() == 0) throw BadInput(path + ": holds no tick");
  Exporter exporter(recorder.facts(), targets);
  ligature_msg::tick_batch_t batch{};
  batch.session = recorder.session();
  recorder.visit([&](const ligature_msg::tick_t& tick) {
    batch.ticks.assign(1, tick);
    exporter.take(batch);
  });
  ExportResult result = exporter.commit();
  if (recorder.damaged_slots() > 0) result.damage = std::to_string(recorder.damaged_slots()) + " slots were damaged";
  return result;
}

}  // namespace

ExportResult export_csv(const std::string& log_path, const ExportTargets& targets) {
  if (is_flight_file(log_path)) return export_flight(log_path, targets);
  Exporter exporter(read_rig_facts(log_path), targets);
  LogReader log(log_path);
  while (const LogEvent* event = log.next()) {
    exporter.take(*event);
    if (stop_requested()) throw RunFailed("export stopped by a signal; nothing was written");
  }
  if (!exporter.has_ticks())
    throw BadInput(log_path + ": holds no readable tick in " + std::to_string(log.events()) +
                   " events; allowed: a log with messages on " + std::string(kTicksChannel));
  ExportResult result = exporter.commit();
  result.damage = log.damage();
  return result;
}

}  // namespace ligature::host
