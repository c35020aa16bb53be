// Binds recordings: columns, shapes, events and scenes, read by the host's readers.

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "host/recording_reader.hpp"
#include "python/src/arrays.hpp"
#include "python/src/bindings.hpp"
#include "python/src/recorded.hpp"

namespace ligature::python {
namespace {

Recorded read(const std::string& path) {
  const nb::gil_scoped_release free;
  Recorded recorded(host::read_rig_facts(path));
  host::ExportSink* const sinks[] = {&recorded};
  recorded.result = host::read_recording(path, recorded.facts, sinks);
  return recorded;
}

nb::dict shapes(Recorded& r) {
  nb::dict columns;
  columns["t_s"] = taken(r.shape_t_s);
  columns["tick"] = taken(r.shape_tick);
  columns["count"] = taken(r.shape_count);
  columns["radius_m"] = taken(r.radius_m);
  const std::size_t nodes = r.p_W_m.size() / 3;
  columns["p_W_m"] = array_of(std::move(r.p_W_m), {nodes, 3});
  columns["tension_N"] = taken(r.tension_N);
  columns["turn_rad"] = taken(r.turn_rad);
  return columns;
}

nb::list events(const Recorded& r) {
  nb::list rows;
  for (const auto& e : r.events) rows.append(nb::make_tuple(e.t_s, e.tick, e.kind, e.hand, e.code, text_of(e.text)));
  return rows;
}

nb::list scenes(const Recorded& r) {
  nb::list rows;
  for (const auto& s : r.scenes) rows.append(nb::make_tuple(s.t_s, text_of(s.file), text_of(s.toml)));
  return rows;
}

nb::dict meanings() {
  nb::dict columns;
  columns["t_s"] = nb::make_tuple("s", host::kTimeMeaning);
  columns["session"] = nb::make_tuple("", host::kSessionMeaning);
  for (const auto& column : host::tick_columns())
    columns[column.name.c_str()] = nb::make_tuple(column.unit, column.meaning);
  return columns;
}

}  // namespace

void bind_recording(nb::module_& module) {
  nb::class_<Recorded>(module, "_Recorded")
      .def("ticks", &ticks_of)
      .def("shapes", &shapes)
      .def("events", &events)
      .def("scenes", &scenes)
      .def_prop_ro("period_s", [](const Recorded& r) { return r.facts.period_s; })
      .def_prop_ro("max_force_N", [](const Recorded& r) { return r.facts.max_force_N; })
      .def_prop_ro("firmware_version", [](const Recorded& r) { return text_of(r.facts.firmware_version); })
      .def_prop_ro("missing", [](const Recorded& r) { return r.result.missing; })
      .def_prop_ro("damage", [](const Recorded& r) { return text_of(r.result.damage); });
  module.def("_read_recording", &read, nb::arg("path"));
  module.def("_tick_meanings", &meanings);
}

}  // namespace ligature::python
