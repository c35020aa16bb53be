#include "host/export_mcap.hpp"

#include <array>
#include <charconv>

#include "host/mcap/writer.hpp"
#include "host/viewer_topics.hpp"

namespace ligature::host {
namespace {

std::string shortest(double value) {
  std::array<char, 32> digits{};
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

class McapSink final : public ExportSink {
 public:
  McapSink(const std::string& path, const RigFacts& facts, const std::string& source)
      : file_(path, "ligature-host " LIGATURE_VERSION),
        facts_{{"format", "ligature recording 1"},
               {"source", source},
               {"host_version", LIGATURE_VERSION},
               {"firmware_version", facts.firmware_version},
               {"scene_file", facts.scene_file},
               {"scene_toml", facts.scene_toml},
               {"period_s", shortest(facts.period_s)},
               {"max_force_N", shortest(facts.max_force_N)},
               {"units", "SI; the schema of a topic has the unit and the meaning of each field"}} {
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      const auto& [name, schema_name, schema] = viewer_topics()[i];
      channels_[i] = file_.add_channel(name, schema_name, schema);
    }
  }

  void add(const ligature_msg::tick_t& tick, double t_s, int session) override {
    const auto& messages = tick_json_.write(tick, session);
    for (std::size_t topic = 0; topic < messages.size(); ++topic) say(topic, t_s, messages[topic]);
  }
  void add(const ligature_msg::thread_t& thread, double t_s) override {
    say(kThreadTopic, t_s, shape_json(thread, viewer_time_ns(t_s)));
  }
  void add(const ligature_msg::event_t& event, double t_s) override { say(kEventsTopic, t_s, event_json(event)); }
  void add(const ligature_msg::status_t& status, double t_s) override {
    const std::string name = "scene-" + std::to_string(++scenes_) + ".toml";
    file_.add_attachment(name, "application/toml", viewer_time_ns(t_s), status.scene_toml);
    facts_.emplace_back(name, status.scene_file);  // where it came from
  }
  void commit() override {
    facts_.emplace_back("notes", notes_);
    file_.add_metadata("ligature", facts_);
    file_.commit();
  }

 private:
  void say(std::size_t topic, double t_s, std::string_view message) {
    file_.add_message(channels_[topic], viewer_time_ns(t_s), message);
  }

  mcap::Writer file_;
  mcap::Pairs facts_;
  TickJson tick_json_;
  std::array<std::uint16_t, kViewerTopics> channels_{};
  int scenes_ = 0;
};

}  // namespace

std::unique_ptr<ExportSink> make_mcap_sink(const std::string& path, const RigFacts& facts, const std::string& source) {
  return std::make_unique<McapSink>(path, facts, source);
}

}  // namespace ligature::host
