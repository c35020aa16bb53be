#pragma once
// Connects the simulated bus to its clients, which send and receive frames.

#include <poll.h>

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "protocol/can/local_wire.hpp"

namespace ligature::sim {

struct Received {
  can::Frame frame;
  int client = 0;  ///< slot of the client, from 0; reused after the client has left
};

/// The clients of a simulated bus. No function blocks.
class Port {
 public:
  virtual ~Port() = default;
  Port() = default;
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;

  /// Appends the descriptors to wait for.
  virtual void add_descriptors(std::vector<pollfd>& fds) const = 0;
  /// Accepts new clients and reads all frames, in order per client; appends frames, and the slots of clients that left.
  virtual void receive(std::vector<Received>& frames, std::vector<int>& left) = 0;
  /// Sends a frame to all clients but one; a client that does not read fast enough loses the frame, as a CAN controller
  /// with full buffers does.
  virtual void send(const can::Frame& frame, int except_client) = 0;
  [[nodiscard]] virtual int clients() const noexcept = 0;
  /// True if the medium itself takes the time of a frame, so that the simulated bus must not add it.
  [[nodiscard]] virtual bool charges_bit_time() const noexcept = 0;
  [[nodiscard]] virtual long dropped_frames() const noexcept = 0;
};

/// Opens `local:/path/socket` (and listens there) or `socketcan:interface`. @return the port, or one line that says why
/// not. @param network  the frames that the drives understand
[[nodiscard]] std::variant<std::unique_ptr<Port>, std::string> open_port(const std::string& url,
                                                                         can::Network network = can::Network::kClassic);

}  // namespace ligature::sim
