#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace ligature::host::stream {

struct FoxgloveOptions {
  std::string listen = "127.0.0.1";
  std::uint16_t port = 8765;                 // the port that Foxglove proposes; 0: any free port
  std::vector<std::string> allowed_origins;  // web sites that may read beside Foxglove's own
};

/// One message of a topic (index into viewer_topics()).
struct TopicMessage {
  std::uint32_t topic = 0;
  std::uint64_t time_ns = 0;
  std::string text;
};

/// Serves viewers over the Foxglove WebSocket protocol, on a thread of its own. Viewers can read and nothing else. At
/// most 8 at a time.
class FoxgloveServer {
 public:
  /// @throws BadInput for an invalid address, RunFailed when it cannot be bound.
  explicit FoxgloveServer(const FoxgloveOptions& options);
  /// Closes all connections and waits for the thread.
  ~FoxgloveServer();
  FoxgloveServer(const FoxgloveServer&) = delete;
  FoxgloveServer& operator=(const FoxgloveServer&) = delete;

  [[nodiscard]] std::uint16_t port() const;
  /// Sends messages to all viewers that have subscribed to their topics. May be called from any thread; never waits.
  void publish(std::vector<TopicMessage> messages);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace ligature::host::stream
