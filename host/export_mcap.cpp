#include "host/export_mcap.hpp"

#include "host/atomic_file.hpp"
#include "host/console/python_tool.hpp"
#include "host/export_hdf5.hpp"

namespace ligature::host {
namespace {

/// Collects everything in a temporary HDF5 file, which the script to_mcap.py converts to MCAP at commit().
class McapSink final : public ExportSink {
 public:
  McapSink(const std::string& path, const RigFacts& facts, const std::string& source)
      : target_(AtomicFile(path).path()),  // creates and removes the file: tests early that it can be created
        tool_("to_mcap.py", LIGATURE_PLOTS_DIR),
        gathered_(make_hdf5_sink(scratch_.file("recording.h5"), facts, source)) {}

  void add(const ligature_msg::tick_t& tick, double t_s, int session) override { gathered_->add(tick, t_s, session); }
  void add(const ligature_msg::thread_t& thread, double t_s) override { gathered_->add(thread, t_s); }
  void add(const ligature_msg::event_t& event, double t_s) override { gathered_->add(event, t_s); }
  void add(const ligature_msg::status_t& status, double t_s) override { gathered_->add(status, t_s); }
  void note(const std::string& text) override { gathered_->note(text); }
  void commit() override {
    gathered_->commit();
    gathered_.reset();
    tool_.run({scratch_.file("recording.h5"), "--out", target_}, scratch_.file("complaints"));
  }

 private:
  std::string target_;
  console::PythonTool tool_;
  console::ScratchFolder scratch_;
  std::unique_ptr<ExportSink> gathered_;
};

}  // namespace

std::unique_ptr<ExportSink> make_mcap_sink(const std::string& path, const RigFacts& facts, const std::string& source) {
  return std::make_unique<McapSink>(path, facts, source);
}

}  // namespace ligature::host
