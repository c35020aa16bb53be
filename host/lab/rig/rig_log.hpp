#pragma once
// Interface of the log to which a run of the virtual rig is written. It is an interface so that programs that write no
// log need no LCM library.

#include <cstdint>
#include <string>

#include "firmware/rt/tick_record.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::lab {

class RigLog {
 public:
  virtual ~RigLog() = default;
  /// @throws host::RunFailed when writing fails (disk full).
  virtual void take(const rt::TickRecord& record) = 0;
  virtual void take(const rt::ThreadSnapshot& shape) = 0;
  /// Another scene or other parameters are in force from tick `first_tick` on.
  virtual void scene_changed(const scene::Scene& scene, std::string scene_toml, std::int64_t first_tick) = 0;
  /// Writes what is left.
  virtual void close() = 0;
};

}  // namespace ligature::lab
