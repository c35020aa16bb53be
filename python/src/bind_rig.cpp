// Python bindings for ligature.rig: the virtual rig for tests, and a reader for the messages of a rig that runs as
// several processes.

#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>

#include "firmware/telemetry/messages.hpp"
#include "host/lab/rig/stepped_rig.hpp"
#include "host/messages.hpp"
#include "protocol/lcm/command_words.hpp"
#include "protocol/scene/fault_script.hpp"
#include "python/src/arrays.hpp"
#include "python/src/bindings.hpp"
#include "python/src/float_mode.hpp"
#include "python/src/inputs.hpp"
#include "python/src/or_refuse.hpp"
#include "python/src/recorded.hpp"

namespace ligature::python {
namespace {

constexpr std::int64_t kPiece = 50;  // periods between two looks for signals; some 5 ms

std::vector<scene::FaultScript> faults_of(const std::vector<std::string>& paths) {
  std::vector<scene::FaultScript> faults;
  faults.reserve(paths.size());
  for (const auto& path : paths) faults.push_back(or_refuse(scene::load_fault_script(path)));
  return faults;
}

/// A virtual rig; while advance() has released the GIL, other Python threads must not touch it.
class Rig {
 public:
  Rig(const Scene& scene, const std::vector<std::string>& faults) : rig_(make(scene, faults_of(faults))) {}

  lab::SteppedRig& idle() {
    if (busy_) throw std::runtime_error("this rig is running in another thread");
    return *rig_;
  }

  void advance(std::int64_t periods) {
    auto& rig = idle();
    for (std::int64_t left = periods; left > 0; left -= kPiece) {
      busy_ = true;
      try {
        const nb::gil_scoped_release free;
        rig.advance(std::min(left, kPiece));
      } catch (...) {
        busy_ = false;
        throw;
      }
      busy_ = false;
      if (PyErr_CheckSignals() != 0) throw nb::python_error();
    }
  }

 private:
  static std::unique_ptr<lab::SteppedRig> make(const Scene& scene, const std::vector<scene::FaultScript>& faults) {
    const DefaultFloats floats;
    try {
      return std::make_unique<lab::SteppedRig>(scene.scene, faults);
    } catch (const std::runtime_error& why) {
      throw lab::Refusal(scene.path + ": " + why.what());
    }
  }

  std::unique_ptr<lab::SteppedRig> rig_;
  bool busy_ = false;
};

void command(Rig& rig, const std::string& word) {
  const auto kind = lcm_tools::command_kind(word);
  if (!kind || word == "load-scene" || word == "set")
    throw lab::Refusal("command: found '" + word +
                       "', allowed arm, disarm, stop, reset-fault, reset-thread, park, calibrate");
  rig.idle().command(static_cast<rt::CommandKind>(*kind));
}

void wish(Rig& rig, int hand, const std::array<double, 3>& p_W_m, bool dead_man, bool grip) {
  if (hand != 0 && hand != 1)
    throw lab::Refusal("hand: found " + std::to_string(hand) + ", allowed 0 (left) or 1 (right)");
  const sim::Vec3 p(p_W_m.data());
  if (!p.allFinite()) throw lab::Refusal("place: found what is no finite number, allowed metres");
  rig.idle().wish(static_cast<std::size_t>(hand), {p, dead_man, grip});
}

nb::dict ticks_of_rig(Rig& rig, std::int64_t first) {
  const auto& records = rig.idle().records();
  Recorded table{host::RigFacts{}};
  const auto size = static_cast<std::int64_t>(records.size());
  for (std::int64_t i = std::clamp<std::int64_t>(first < 0 ? size + first : first, 0, size); i < size; ++i) {
    const auto& record = records[static_cast<std::size_t>(i)];
    table.add(telemetry::to_message(record), table.facts.time_s(record.tick), 1);
  }
  return ticks_of(table);
}

View<double> nodes(Rig& rig) {
  std::vector<double> values;
  for (const auto& p : rig.idle().nodes_W()) values.insert(values.end(), p.data(), p.data() + 3);
  const std::size_t n = values.size() / 3;
  return array_of(std::move(values), {n, 3});
}

/// Columns of the batches of one rig, as received; a message that is no batch is left out.
nb::dict ticks_of_batches(const std::vector<nb::bytes>& batches) {
  Recorded table{host::RigFacts{}};
  for (const auto& bytes : batches) {
    const auto batch =
        host::decode<ligature_msg::tick_batch_t>({reinterpret_cast<const std::byte*>(bytes.c_str()), bytes.size()});
    if (!batch) continue;
    for (const auto& tick : batch->ticks) table.add(tick, table.facts.time_s(tick.tick), 1);
  }
  return ticks_of(table);
}

std::string objection(const Scene& scene, const std::array<double, 3>& p_W_m) {
  return lab::out_of_reach(scene.scene, sim::Vec3(p_W_m.data()));
}

}  // namespace

void bind_rig(nb::module_& module) {
  nb::class_<Rig>(module, "_Rig")
      .def(nb::init<const Scene&, const std::vector<std::string>&>(), nb::arg("scene"), nb::arg("faults"))
      .def("advance", &Rig::advance, nb::arg("periods"))
      .def("command", &command, nb::arg("word"))
      .def("wish", &wish, nb::arg("hand"), nb::arg("p_W_m"), nb::arg("dead_man"), nb::arg("grip"))
      .def("ticks", &ticks_of_rig, nb::arg("first"))
      .def("nodes", &nodes, nb::rv_policy::automatic)
      .def_prop_ro("count", [](Rig& r) { return r.idle().records().size(); });
  module.def("_ticks_of", &ticks_of_batches, nb::arg("batches"));
  module.def("_out_of_reach", &objection, nb::arg("scene"), nb::arg("p_W_m"));
  module.def(
      "_fault_hand", [](const std::string& path) { return or_refuse(scene::load_fault_script(path)).hand; },
      nb::arg("path"));
}

}  // namespace ligature::python
