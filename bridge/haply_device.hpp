#pragma once
#include <chrono>
#include <memory>
#include <string>

#include "bridge/haply_messages.hpp"

namespace ligature::bridge {

/// Opens an Inverse3 (a haptic device) through Haply's Inverse Service. Each exchange() sends one message and reads the
/// answer. Later calls open a lost connection again. @param url ws://HOST:PORT. @param answer_within the connection is
/// given up when an answer does not come within this time.
[[nodiscard]] OpenedDevice open_haply(const std::string& url, const HaplyChoice& choice,
                                      std::chrono::nanoseconds answer_within);

}  // namespace ligature::bridge
