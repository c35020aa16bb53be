#pragma once
// Where the simulated cable meets the outside: a set of clients that put frames on it and hear it.

#include <poll.h>

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "protocol/can/frame.hpp"

namespace ligature::sim {

struct Received {
  can::Frame frame;
  int client = 0;  ///< 0 .. clients() - 1 or higher: a slot, reused after its client left
};

/// Nothing here blocks.
class Port {
 public:
  virtual ~Port() = default;
  Port() = default;
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;

  /// Descriptors to wait for; appended.
  virtual void add_descriptors(std::vector<pollfd>& fds) const = 0;
  /// Takes in new clients and everything they sent, in order per client; both lists are appended to.
  virtual void receive(std::vector<Received>& frames, std::vector<int>& left) = 0;
  /// Everybody but one hears a frame; a client that does not read fast enough loses it, as on a full controller.
  virtual void send(const can::Frame& frame, int except_client) = 0;
  [[nodiscard]] virtual int clients() const noexcept = 0;
  /// True when the medium below takes the time a frame needs, so that the simulated wire must not.
  [[nodiscard]] virtual bool charges_bit_time() const noexcept = 0;
  [[nodiscard]] virtual long dropped_frames() const noexcept = 0;
};

/// Opens `local:/path/socket` (and listens there) or `socketcan:interface`; or says in one line why not.
[[nodiscard]] std::variant<std::unique_ptr<Port>, std::string> open_port(const std::string& url);

}  // namespace ligature::sim
