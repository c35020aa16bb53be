#pragma once
#include <thread>

#include "host/view/picture.hpp"

namespace ligature::host::view {

/// Names the knot of the newest shape 20 times a second, on its own thread of execution, and gives it to the picture.
class KnotWatch {
 public:
  explicit KnotWatch(Picture& picture);

 private:
  void watch(const std::stop_token& stop);

  Picture& picture_;
  std::jthread thread_;
};

}  // namespace ligature::host::view
