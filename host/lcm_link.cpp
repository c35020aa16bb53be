#include "host/lcm_link.hpp"

#include <poll.h>
#include <signal.h>

#include <exception>
#include <lcm/lcm-cpp.hpp>
#include <utility>

#include "host/errors.hpp"
#include "protocol/lcm/quiet_stderr.hpp"

namespace ligature::host {
namespace {

/// Size of the queue between LCM's thread and receive(): more than a minute of all messages of a rig.
constexpr int kQueuedMessages = 16384;

/// Threads created while this object lives have all signals blocked, so that signals reach the main thread.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_ = {};
};

}  // namespace

struct LcmLink::Receiver {
  Handler handler;
  std::exception_ptr failure;  // thrown by the handler; it must not pass through LCM's C stack frames

  /// A static function, because GCC's -fsanitize=vptr miscompiles LCM's wrapper for member functions: its check uses
  /// the object's address before that is computed.
  static void on_message(const lcm::ReceiveBuffer* buffer, const std::string& channel, Receiver* to) noexcept {
    if (to->failure) return;
    try {
      to->handler({buffer->recv_utime, channel, Bytes(static_cast<const std::byte*>(buffer->data), buffer->data_size)});
    } catch (...) {
      to->failure = std::current_exception();
    }
  }
};

LcmLink::LcmLink(const std::string& url, const std::string& channels, Handler handler)
    : receiver_(std::make_unique<Receiver>(Receiver{std::move(handler), nullptr})) {
  const bool is_multicast = url.starts_with("udpm://");
  if (!is_multicast && !url.starts_with("tcpq://") && !url.starts_with("memq://"))
    throw BadInput("--lcm-url: found '" + url + "', allowed udpm://ADDRESS:PORT[?ttl=N&recv_buf_size=BYTES]");
  const SignalsBlocked in_the_library;
  lcm::Subscription* subscription = nullptr;
  {
    const lcm_tools::QuietStderr one_line_is_enough;
    lcm_ = std::make_unique<lcm::LCM>(url);
    if (lcm_->good()) subscription = lcm_->subscribeFunction(channels, &Receiver::on_message, receiver_.get());
  }
  if (!subscription)
    throw RunFailed("cannot open " + url +
                    ": wrong address or port, or no multicast route; remedy: run inside "
                    "scripts/private-net, or 'ip link set lo up; ip route add 224.0.0.0/4 dev lo' as root");
  subscription->setQueueCapacity(kQueuedMessages);
}

LcmLink::~LcmLink() = default;

int LcmLink::receive(int timeout_ms) {
  pollfd waiting{.fd = lcm_->getFileno(), .events = POLLIN, .revents = 0};
  int handled = 0;
  while (poll(&waiting, 1, handled ? 0 : timeout_ms) > 0) {
    if (lcm_->handle() != 0) throw RunFailed("LCM: receiving failed");
    if (receiver_->failure) std::rethrow_exception(receiver_->failure);
    if (++handled == 256) break;  // return now and then, so that the caller can check the time
  }
  return handled;
}

void LcmLink::publish_bytes(std::string_view channel, Bytes bytes) {
  const auto size = static_cast<unsigned>(bytes.size());
  if (lcm_->publish(std::string(channel), bytes.data(), size) != 0) throw RunFailed("LCM: sending failed");
}

}  // namespace ligature::host
