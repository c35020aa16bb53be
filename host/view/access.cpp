#include "host/view/access.hpp"

#include <arpa/inet.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "host/errors.hpp"

namespace ligature::host::view {
namespace {

constexpr std::size_t kShortestToken = 16, kLongestToken = 256;

bool is_address(const std::string& name) {
  std::array<unsigned char, 16> binary{};
  return inet_pton(AF_INET, name.c_str(), binary.data()) == 1 || inet_pton(AF_INET6, name.c_str(), binary.data()) == 1;
}

/// The name in a Host header: "name:port", "name", "[v6]:port" or "[v6]"; empty for anything else.
std::string without_port(std::string_view host) {
  const auto closing = host.starts_with('[') ? host.find(']') : 0;
  if (closing == std::string_view::npos) return {};
  const auto colon = host.find(':', closing);
  const auto port = colon == std::string_view::npos ? std::string_view() : host.substr(colon + 1);
  if (!std::ranges::all_of(port, [](char c) { return c >= '0' && c <= '9'; })) return {};
  if (closing == 0) return std::string(host.substr(0, colon));
  return closing + 1 == std::min(colon, host.size()) ? std::string(host.substr(1, closing - 1)) : std::string();
}

}  // namespace

std::string make_token() {
  std::array<unsigned char, 16> bits{};
  if (getrandom(bits.data(), bits.size(), 0) != static_cast<ssize_t>(bits.size()))
    throw RunFailed("the kernel gives no random numbers for the token");
  std::string token;
  for (const unsigned byte : bits) {
    token += "0123456789abcdef"[byte >> 4U];
    token += "0123456789abcdef"[byte & 15U];
  }
  return token;
}

std::string read_token_file(const std::string& path) {
  std::ifstream file(path);
  std::string token;
  if (!file || !std::getline(file, token)) throw BadInput("--token-file: cannot read '" + path + "'");
  const bool is_printable = std::ranges::all_of(token, [](char c) { return c > ' ' && c <= '~'; });
  if (token.size() < kShortestToken || token.size() > kLongestToken || !is_printable)
    throw BadInput("--token-file: " + path + ": found " + std::to_string(token.size()) +
                   " characters in its first line, allowed 16 .. 256 printable ones without blanks");
  return token;
}

bool is_token(std::string_view found, std::string_view expected) noexcept {
  if (expected.empty() || found.size() != expected.size()) return false;
  unsigned differs = 0;
  for (std::size_t i = 0; i < found.size(); ++i) differs |= static_cast<unsigned>(found[i] ^ expected[i]);
  return differs == 0;
}

std::string objection_to(std::string_view token, const Access& access) {
  if (access.token.empty()) return "this view may only look: it was started without a token";
  if (!is_token(token, access.token))
    return "the token is not the one of this view; open the address that its start printed";
  return {};
}

bool is_own_host(std::string_view host_header, std::string_view machine_name) {
  const std::string name = without_port(host_header);
  return name == "localhost" || is_address(name) || (!machine_name.empty() && name == machine_name);
}

bool is_own_origin(std::string_view origin, std::string_view host_header) {
  if (origin.empty()) return true;
  constexpr std::string_view kScheme = "http://";
  return origin.starts_with(kScheme) && origin.substr(kScheme.size()) == host_header && !host_header.empty();
}

}  // namespace ligature::host::view
