#pragma once
// Collects a whole recording in memory, column by column.

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "host/export_sink.hpp"
#include "host/recording_reader.hpp"
#include "host/tick_columns.hpp"
#include "python/src/arrays.hpp"

namespace ligature::python {

struct Recorded final : host::ExportSink {
  explicit Recorded(host::RigFacts of) : facts(std::move(of)) {
    for (const auto& column : host::tick_columns()) {
      if (std::holds_alternative<host::TickColumn::Real>(column.value))
        columns.emplace_back(std::vector<double>());
      else
        columns.emplace_back(std::vector<std::int64_t>());
    }
  }

  void add(const ligature_msg::tick_t& tick, double time_s, int number) override {
    t_s.push_back(time_s);
    session.push_back(number);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const auto& value = host::tick_columns()[i].value;
      if (auto* real = std::get_if<std::vector<double>>(&columns[i]))
        real->push_back(std::get<host::TickColumn::Real>(value)(tick));
      else
        std::get<std::vector<std::int64_t>>(columns[i]).push_back(std::get<host::TickColumn::Whole>(value)(tick));
    }
  }
  void add(const ligature_msg::thread_t& thread, double time_s) override {
    shape_t_s.push_back(time_s);
    shape_tick.push_back(thread.tick);
    shape_count.push_back(thread.count);
    radius_m.push_back(thread.radius_m);
    for (const auto& p : thread.p_W_m) p_W_m.insert(p_W_m.end(), p.begin(), p.end());
    tension_N.insert(tension_N.end(), thread.tension_N.begin(), thread.tension_N.end());
    turn_rad.insert(turn_rad.end(), thread.turn_rad.begin(), thread.turn_rad.end());
  }
  void add(const ligature_msg::event_t& event, double time_s) override {
    events.push_back({time_s, event.tick, event.kind, event.hand, event.code, event.text});
  }
  void add(const ligature_msg::status_t& status, double time_s) override {
    scenes.push_back({time_s, status.scene_file, status.scene_toml});
  }
  void commit() override {}

  struct Event {
    double t_s;
    std::int64_t tick;
    int kind, hand, code;
    std::string text;
  };
  struct SceneText {
    double t_s;
    std::string file, toml;
  };
  host::RigFacts facts;
  host::ExportResult result;
  std::vector<double> t_s;
  std::vector<std::int64_t> session;
  // all values of each tick column, in the order of host::tick_columns()
  std::vector<std::variant<std::vector<std::int64_t>, std::vector<double>>> columns;
  std::vector<double> shape_t_s;
  std::vector<std::int64_t> shape_tick, shape_count;
  std::vector<float> radius_m, p_W_m, tension_N, turn_rad;
  std::vector<Event> events;
  std::vector<SceneText> scenes;
};

/// Moves a column's data into a NumPy array without a copy.
template <class T>
auto taken(std::vector<T>& values) {
  const std::size_t n = values.size();
  return array_of(std::move(values), {n});
}

/// All tick columns, which are empty afterwards.
inline nb::dict ticks_of(Recorded& r) {
  nb::dict columns;
  columns["t_s"] = taken(r.t_s);
  columns["session"] = taken(r.session);
  for (std::size_t i = 0; i < r.columns.size(); ++i)
    std::visit([&](auto& values) { columns[host::tick_columns()[i].name.c_str()] = taken(values); }, r.columns[i]);
  return columns;
}

}  // namespace ligature::python
