#pragma once
#include <string_view>

namespace ligature::lcm_tools {

/// ttl=0: packets stay on this machine. The receive buffer is large, because overflow of a small one loses messages.
inline constexpr std::string_view kDefaultUrl = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";

}  // namespace ligature::lcm_tools
