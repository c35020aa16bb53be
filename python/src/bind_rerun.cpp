// Binds reruns: the thread of a recording computed again, collected in memory.

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cfenv>

#include "host/gap_counter.hpp"
#include "host/lab/rerun/rerun.hpp"
#include "protocol/scene/recorded_scene.hpp"
#include "python/src/bindings.hpp"
#include "python/src/recorded.hpp"
#include "python/src/signals.hpp"

namespace ligature::python {
namespace {

/// Restores the floating-point mode, which a rerun changes to that of the firmware.
class KeptFloats {
 public:
  KeptFloats() { std::fegetenv(&before_); }
  ~KeptFloats() { std::fesetenv(&before_); }
  KeptFloats(const KeptFloats&) = delete;
  KeptFloats& operator=(const KeptFloats&) = delete;

 private:
  std::fenv_t before_{};
};

struct Rerun {
  Recorded recorded;
  std::optional<lab::RerunOutcome> outcome;
  std::vector<double> cost_us;
};

/// Collects what `ligature-lab rerun` would write to rerun.lcmlog.
class Gathered final : public lab::RerunOutput {
 public:
  Gathered(Rerun& rerun, std::vector<std::string> overrides) : rerun_(rerun), overrides_(std::move(overrides)) {}

  void begin(const host::LogEvent&) override {}
  void add(const ligature_msg::tick_t&, const ligature_msg::tick_t& again, std::optional<double> cost_us) override {
    add_unknown(again);
    if (cost_us) rerun_.cost_us.push_back(*cost_us);
  }
  void add_unknown(const ligature_msg::tick_t& tick) override {
    numbers_.add(tick.tick);
    rerun_.recorded.add(tick, time_s(tick.tick), 1);
  }
  void add(const ligature_msg::thread_t&, const ligature_msg::thread_t& again) override {
    rerun_.recorded.add(again, time_s(again.tick));
  }
  void add(const ligature_msg::status_t& status) override {
    if (status.scene_toml == toml_ && status.scene_file == file_) return;
    file_ = status.scene_file, toml_ = status.scene_toml;
    auto as_run = status;
    for (const auto& o : overrides_) scene::add_override(as_run.scene_toml, o);
    rerun_.recorded.add(as_run, time_s(status.scene_first_tick));
  }
  void copy(const host::LogEvent& event) override {
    if (const auto told = host::decode<ligature_msg::event_t>(event.data))
      rerun_.recorded.add(*told, time_s(told->tick));
  }
  void close() override { rerun_.recorded.result.missing = numbers_.missing(); }

 private:
  [[nodiscard]] double time_s(std::int64_t tick) const { return rerun_.recorded.facts.time_s(tick); }

  Rerun& rerun_;
  std::vector<std::string> overrides_;
  host::GapCounter numbers_;
  std::string file_, toml_;
};

Rerun rerun(const std::string& path, std::vector<std::string> overrides, bool cuts, int session) {
  Signals signals;
  std::optional<Rerun> made;
  {
    const nb::gil_scoped_release free;
    const KeptFloats floats;
    made.emplace(Rerun{Recorded(host::read_rig_facts(path)), {}, {}});
    lab::RerunOptions options{.log = path, .overrides = overrides, .cuts = cuts, .session = session};
    options.output = [&](const lab::RecordedRun&) { return std::make_unique<Gathered>(*made, overrides); };
    options.go_on = [&] { return signals(); };
    made->outcome.emplace(lab::rerun(options));
  }
  signals.rethrow();
  const auto& outcome = made.value().outcome.value();
  if (outcome.differences.ticks() == 0)
    throw lab::Refusal(path + ": no tick could be computed again: " + outcome.why_unknown);
  return std::move(made.value());
}

nb::dict facts(const Rerun& r) {
  const auto& o = r.outcome.value();
  const auto& d = o.differences;
  nb::dict all;
  all["equal"] = d.are_none();
  all["first_difference"] = text_of(d.first());
  all["unknown_ticks"] = o.unknown_ticks;
  for (std::size_t h = 0; h < 2; ++h) {
    const std::string hand = h == 0 ? "left_" : "right_";
    all[(hand + "peak_N").c_str()] = d.again().force[h].peak_N;
    all[(hand + "apart_rms_N").c_str()] = d.apart()[h].rms_N(d.ticks());
  }
  all["lost_ticks"] = d.again().lost_ticks;
  nb::list knots;
  for (const auto& [t_s, type] : d.again().knots) knots.append(nb::make_tuple(t_s, text_of(type)));
  all["knots"] = knots;
  return all;
}

}  // namespace

void bind_rerun(nb::module_& module) {
  nb::class_<Rerun>(module, "_Rerun")
      .def("facts", &facts)
      .def_prop_ro(
          "recorded", [](Rerun& r) -> Recorded& { return r.recorded; }, nb::rv_policy::reference_internal)
      .def("cost_us", [](Rerun& r) { return taken(r.cost_us); });
  module.def("_rerun", &rerun, nb::arg("path"), nb::arg("overrides"), nb::arg("cuts"), nb::arg("session"));
}

}  // namespace ligature::python
