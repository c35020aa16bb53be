#include "host/export_hdf5.hpp"

#include <variant>
#include <vector>

#include "host/atomic_file.hpp"
#include "host/errors.hpp"
#include "host/hdf5_file.hpp"
#include "host/tick_columns.hpp"

namespace ligature::host {
namespace {

using hdf5::annotate;
using hdf5::Handle;
using hdf5::Series;
using Whole = Series<std::int64_t>;
using Real = Series<double>;

void explain(hid_t dataset, const std::string& unit, const std::string& meaning) {
  annotate(dataset, "unit", unit);
  annotate(dataset, "meaning", meaning);
}

/// The columns of ticks.csv, one dataset each.
class Ticks {
 public:
  explicit Ticks(hid_t file)
      : group_(hdf5::make_group(file, "ticks")), time_(group_.id(), "t_s"), session_(group_.id(), "session") {
    explain(time_.id(), "s", kTimeMeaning);
    explain(session_.id(), "", kSessionMeaning);
    for (const TickColumn& column : tick_columns()) {
      if (std::holds_alternative<TickColumn::Real>(column.value))
        columns_.emplace_back(Real(group_.id(), column.name.c_str()));
      else
        columns_.emplace_back(Whole(group_.id(), column.name.c_str()));
      std::visit([&](const auto& series) { explain(series.id(), column.unit, column.meaning); }, columns_.back());
    }
  }
  void add(const ligature_msg::tick_t& tick, double t_s, int session) {
    time_.add(t_s);
    session_.add(session);
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const auto& value = tick_columns()[i].value;
      if (auto* real = std::get_if<Real>(&columns_[i]))
        real->add(std::get<TickColumn::Real>(value)(tick));
      else
        std::get<Whole>(columns_[i]).add(std::get<TickColumn::Whole>(value)(tick));
    }
  }
  void flush() {
    time_.flush();
    session_.flush();
    for (auto& column : columns_) std::visit([](auto& series) { series.flush(); }, column);
  }

 private:
  Handle group_;
  Real time_;
  Whole session_;
  std::vector<std::variant<Whole, Real>> columns_;
};

/// Shapes of the thread. Shape i has its own number of nodes: rows first[i] .. first[i] + count[i] - 1 of p_W_m.
struct Shapes {
  explicit Shapes(hid_t file)
      : group(hdf5::make_group(file, "shapes")),
        time(group.id(), "t_s"),
        tick(group.id(), "tick"),
        first(group.id(), "first"),
        count(group.id(), "count"),
        radius(group.id(), "radius_m"),
        p_W(group.id(), "p_W_m", 3),
        tension(group.id(), "tension_N"),
        turn(group.id(), "turn_rad") {
    explain(time.id(), "s", kTimeMeaning);
    explain(tick.id(), "ticks", "period whose shape it is");
    explain(first.id(), "", "row of p_W_m at which the shape begins");
    explain(count.id(), "", "its nodes");
    explain(radius.id(), "m", "radius of the thread");
    explain(tension.id(), "N", "of the edge after each node; positive pulls");
    explain(turn.id(), "rad", "material frame against the twist-free one from node 0");
    explain(p_W.id(), "m", "nodes of all shapes, one after the other: x, y, z in the world frame W");
  }
  void flush() {
    time.flush(), tick.flush(), first.flush(), count.flush(), radius.flush(), p_W.flush(), tension.flush(),
        turn.flush();
  }
  Handle group;
  Real time;
  Whole tick, first, count;
  Series<float> radius, p_W, tension, turn;
  std::int64_t rows = 0;
};

struct Events {
  explicit Events(hid_t file)
      : group(hdf5::make_group(file, "events")),
        time(group.id(), "t_s"),
        tick(group.id(), "tick"),
        kind(group.id(), "kind"),
        hand(group.id(), "hand"),
        code(group.id(), "code"),
        text(group.id(), "text") {
    explain(time.id(), "s", kTimeMeaning);
    explain(tick.id(), "ticks", "period in which it happened");
    explain(kind.id(), "",
            "1 state, 2 fault, 3 grasp, 4 release, 5 limit, 6 change of scene or parameter, 7 recorder, 8 refused "
            "command, 9 wait");
    explain(hand.id(), "", "0 left, 1 right, -1 neither or both");
    explain(code.id(), "", "grasp, release: node; state: its number; fault: its number");
    explain(text.id(), "", "one line for people");
  }
  void flush() { time.flush(), tick.flush(), kind.flush(), hand.flush(), code.flush(), text.flush(); }
  Handle group;
  Real time;
  Whole tick, kind, hand, code;
  Series<std::string> text;
};

struct Scenes {
  explicit Scenes(hid_t file)
      : group(hdf5::make_group(file, "scenes")),
        time(group.id(), "t_s"),
        name(group.id(), "file"),
        toml(group.id(), "toml") {
    explain(time.id(), "s", "from when on it is in force");
    explain(name.id(), "", "scene file");
    explain(toml.id(), "", "its text; changed parameters as comments at the end");
  }
  void flush() { time.flush(), name.flush(), toml.flush(); }
  Handle group;
  Real time;
  Series<std::string> name, toml;
};

class Hdf5Sink final : public ExportSink {
 public:
  Hdf5Sink(const std::string& path, const RigFacts& facts, const std::string& source)
      : target_(path),
        file_(hdf5::make_file(target_.part_path())),
        ticks_(file_.id()),
        shapes_(file_.id()),
        events_(file_.id()),
        scenes_(file_.id()) {
    annotate(file_.id(), "format", std::string("ligature recording 1"));
    annotate(file_.id(), "source", source);
    annotate(file_.id(), "host_version", std::string(LIGATURE_VERSION));
    annotate(file_.id(), "firmware_version", facts.firmware_version);
    annotate(file_.id(), "scene_file", facts.scene_file);
    annotate(file_.id(), "scene_toml", facts.scene_toml);
    annotate(file_.id(), "period_s", facts.period_s);
    annotate(file_.id(), "max_force_N", facts.max_force_N);
    annotate(file_.id(), "units", std::string("SI; the unit and the meaning of a column are its attributes"));
  }

  void add(const ligature_msg::tick_t& tick, double t_s, int session) override { ticks_.add(tick, t_s, session); }

  void add(const ligature_msg::thread_t& thread, double t_s) override {
    shapes_.time.add(t_s);
    shapes_.tick.add(thread.tick);
    shapes_.first.add(shapes_.rows);
    shapes_.count.add(thread.count);
    shapes_.radius.add(thread.radius_m);
    for (const auto& p : thread.p_W_m)
      for (const float x : p) shapes_.p_W.add(x);
    for (const float tension : thread.tension_N) shapes_.tension.add(tension);
    for (const float turn : thread.turn_rad) shapes_.turn.add(turn);
    shapes_.rows += thread.count;
  }

  void add(const ligature_msg::event_t& event, double t_s) override {
    events_.time.add(t_s);
    events_.tick.add(event.tick);
    events_.kind.add(event.kind);
    events_.hand.add(event.hand);
    events_.code.add(event.code);
    events_.text.add(event.text);
  }

  void add(const ligature_msg::status_t& status, double t_s) override {
    scenes_.time.add(t_s);
    scenes_.name.add(status.scene_file);
    scenes_.toml.add(status.scene_toml);
  }

  void commit() override {
    ticks_.flush();
    shapes_.flush();
    events_.flush();
    scenes_.flush();
    annotate(file_.id(), "notes", notes_);
    if (H5Fflush(file_.id(), H5F_SCOPE_GLOBAL) < 0) throw RunFailed(target_.path() + ": cannot be written");
    target_.commit();
  }

 private:
  AtomicFile target_;
  Handle file_;
  Ticks ticks_;
  Shapes shapes_;
  Events events_;
  Scenes scenes_;
};

}  // namespace

std::unique_ptr<ExportSink> make_hdf5_sink(const std::string& path, const RigFacts& facts, const std::string& source) {
  return std::make_unique<Hdf5Sink>(path, facts, source);
}

}  // namespace ligature::host
