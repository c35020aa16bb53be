#pragma once
// The thread's ticks done again from the records: the same tools, the same orders, cut at the same questions.

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

/// A scene as the rerun has it, in force from that tick on.
struct PlayedScene {
  std::int64_t first_tick = 0;
  scene::Scene scene;
};

/// Does what firmware/thread_context.hpp did, by the records alone. The thread is known from the run's first tick on;
/// after a hole in the records it is not known, until a reset or another scene says how it lies.
class ThreadPlayer {
 public:
  /// @param scenes in order of their first ticks. @param cuts whether the clock's cuts are done again.
  ThreadPlayer(std::vector<PlayedScene> scenes, bool cuts);

  /// The next record. @return it with the thread's part as it is now; nothing while the thread is not known.
  std::optional<ligature_msg::tick_t> take(const ligature_msg::tick_t& tick);

  /// A shape of one of the ticks since the last call, as telemetry would have told it.
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
  std::size_t current_ = 0;                    // of the scenes
  std::optional<physics::Simulation> thread_;  // nothing: not known
  std::string why_unknown_ = "its beginning is missing";
  std::deque<Request> requests_;  // not looked at yet
  std::int64_t next_tick_ = -1, last_step_ = -1, shape_of_ = -1;
  std::optional<control::ThreadOrders> orders_;  // of the last step; nothing: it was not recorded
  control::ThreadResult result_;
  ligature_msg::tick_t told_{};  // the last record
  std::vector<ligature_msg::thread_t> shapes_;
  std::unique_ptr<rt::ThreadSnapshot> shape_ = std::make_unique<rt::ThreadSnapshot>();
  std::optional<double> cost_us_;
};

}  // namespace ligature::lab
