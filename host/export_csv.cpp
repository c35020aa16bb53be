#include "host/export_csv.hpp"

#include <array>

#include "host/atomic_file.hpp"
#include "host/csv_metadata.hpp"
#include "host/csv_tables.hpp"

namespace ligature::host {
namespace {

struct Table {
  Table(const std::string& path, const std::string& columns)
      : file(path), explanation(file.path() + "-metadata.json"), header(columns) {
    file.write(header);
  }
  void commit(const RigFacts& facts, const std::string& source, const std::string& notes) {
    explanation.write(csv_metadata(file.path(), header, facts, source, notes));
    explanation.commit();
    file.commit();
  }
  AtomicFile file, explanation;
  std::string header;
};

std::unique_ptr<Table> open_table(const std::string& path, const std::string& header) {
  return path.empty() ? nullptr : std::make_unique<Table>(path, header);
}

class CsvSink final : public ExportSink {
 public:
  CsvSink(const CsvTargets& targets, const RigFacts& facts, const std::string& source)
      : forces_(open_table(targets.forces, forces_header())),
        shape_(open_table(targets.shape, shape_header())),
        ticks_(open_table(targets.ticks, ticks_header())),
        facts_(facts),
        source_(source) {}

  void add(const ligature_msg::tick_t& tick, double t_s, int session) override {
    if (forces_) forces_->file.write(forces_row(row_, tick, t_s, session));
    if (ticks_) ticks_->file.write(ticks_row(row_, tick, t_s, session));
  }
  void add(const ligature_msg::thread_t& thread, double t_s) override {
    for (int node = 0; shape_ && node < thread.count; ++node) shape_->file.write(shape_row(row_, thread, t_s, node));
  }
  void commit() override {
    for (auto* table : {forces_.get(), shape_.get(), ticks_.get()})
      if (table) table->commit(facts_, source_, notes_);
  }

 private:
  std::unique_ptr<Table> forces_, shape_, ticks_;
  RigFacts facts_;
  std::string source_;
  CsvRow row_;
};

}  // namespace

std::unique_ptr<ExportSink> make_csv_sink(const CsvTargets& targets, const RigFacts& facts, const std::string& source) {
  return std::make_unique<CsvSink>(targets, facts, source);
}

}  // namespace ligature::host
