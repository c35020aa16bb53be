#pragma once
#include <chrono>
#include <memory>
#include <string>

#include "bridge/haply_messages.hpp"

namespace ligature::bridge {

/// An Inverse3 behind Haply's Inverse Service. Each exchange() is one message and its answer. A lost connection is
/// opened again by later calls. @param url ws://HOST:PORT. @param answer_within the connection is given up when an
/// answer does not come within this time.
[[nodiscard]] OpenedDevice open_haply(const std::string& url, const HaplyChoice& choice,
                                      std::chrono::nanoseconds answer_within);

}  // namespace ligature::bridge
