#pragma once
// Recomputes the thread's ticks from the records, with the recorded tool positions, resets and scene changes. A tick
// that was ended early ends at the same point of the computation.

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "firmware/control/thread_link.hpp"
#include "firmware/physics/simulation.hpp"
#include "ligature_msg/thread_t.hpp"
#include "ligature_msg/tick_t.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::lab {

/// A scene of the rerun, in force from `first_tick` on.
struct PlayedScene {
  std::int64_t first_tick = 0;
  scene::Scene scene;
};

/// Repeats what firmware/thread_context.hpp did, from the records alone. The thread's state is known from the first
/// tick of the run on. After missing records it is unknown until a reset or another scene defines it again.
class ThreadPlayer {
 public:
  /// @param scenes in order of their first ticks. @param cuts whether ticks that the clock ended early end early again.
  ThreadPlayer(std::vector<PlayedScene> scenes, bool cuts);

  /// Takes the next record. @return the record with recomputed thread fields; nothing while the state is unknown.
  std::optional<ligature_msg::tick_t> take(const ligature_msg::tick_t& tick);

  /// Shapes of ticks since the last call, in the form that telemetry sends.
  [[nodiscard]] std::vector<ligature_msg::thread_t> take_shapes() { return std::exchange(shapes_, {}); }

  /// CPU time of the ticks that ended with the last record, us; nothing when none did.
  [[nodiscard]] std::optional<double> cost_us() const { return cost_us_; }
  [[nodiscard]] double force_scale() const { return scenes_[current_].scene.hands.force_scale; }
  [[nodiscard]] double max_force_N() const { return scenes_[current_].scene.hands.max_force_N; }
  [[nodiscard]] const std::string& why_unknown() const { return why_unknown_; }

 private:
  struct Request {
    std::int64_t tick;
    std::array<physics::ToolInput, 2> tools;
    control::ThreadOrders orders;
  };

  void forget(const std::string& why);
  void remember(const ligature_msg::tick_t& tick);
  void step(std::int64_t tick, int cut_at);
  void obey(const Request& request, int cut_at);
  bool take_scene(const Request& request, bool keeps_motion);
  void note_result(std::int64_t tick);
  void snapshot();
  void put_thread(ligature_msg::tick_t& tick);
  [[nodiscard]] std::size_t scene_at(std::int64_t tick) const;
  [[nodiscard]] physics::Simulation made(std::size_t scene) const;

  std::vector<PlayedScene> scenes_;
  bool cuts_;
  std::size_t current_ = 0;                    // index of the scene in force
  std::optional<physics::Simulation> thread_;  // empty: the state is unknown
  std::string why_unknown_ = "its beginning is missing";
  std::deque<Request> requests_;  // requests to the physics that are not carried out yet, oldest first
  std::int64_t next_tick_ = -1, last_step_ = -1, shape_of_ = -1;
  std::optional<control::ThreadOrders> orders_;  // counts of resets and changes at the last step; empty: not recorded
  control::ThreadResult result_;
  ligature_msg::tick_t told_{};  // the last record returned
  std::vector<ligature_msg::thread_t> shapes_;
  std::unique_ptr<rt::ThreadSnapshot> shape_ = std::make_unique<rt::ThreadSnapshot>();
  std::optional<double> cost_us_;
};

}  // namespace ligature::lab
