#include "firmware/platform/bus_wait.hpp"

#include <poll.h>

namespace ligature::platform {

bool PollWait::wait(Nanoseconds deadline) noexcept {
  const Nanoseconds left = deadline - clock_.now();
  if (left <= Nanoseconds::zero()) return false;
  std::array<pollfd, 2> fds{};
  for (std::size_t i = 0; i < fds.size(); ++i) {
    fds[i].fd = buses_[i]->is_lost() ? -1 : buses_[i]->descriptor();  // poll ignores negative descriptors
    fds[i].events = POLLIN;
  }
  const timespec timeout = MonotonicClock::to_timespec(left);
  ppoll(fds.data(), fds.size(), &timeout, nullptr);
  return true;
}

}  // namespace ligature::platform
