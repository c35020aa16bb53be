#pragma once
#include <string>
#include <string_view>

namespace ligature::host::view {

/// Whether pages may send commands to the rig, and with which token.
struct Access {
  std::string token;  // empty: nobody may command
  // whether the server writes the token into the page that it serves; safe only when that page can be loaded from this
  // machine alone
  bool gives_token = false;
};

/// 128 random bits in hexadecimal. @throws RunFailed when the kernel supplies none.
[[nodiscard]] std::string make_token();

/// Reads the token: the first line of a file, at least 16 printable characters. @throws BadInput.
[[nodiscard]] std::string read_token_file(const std::string& path);

/// Compares in constant time, so that the time reveals nothing about the token; false for an empty expected token.
[[nodiscard]] bool is_token(std::string_view found, std::string_view expected) noexcept;

/// Why a request with this token is refused; empty when it is allowed.
[[nodiscard]] std::string objection_to(std::string_view token, const Access& access);

/// Whether a Host header names this machine: by address, as localhost or by its own name. Protects against DNS
/// rebinding: a foreign page whose name was pointed at 127.0.0.1 sends that name and is refused.
[[nodiscard]] bool is_own_host(std::string_view host_header, std::string_view machine_name);

/// Whether a page with this Origin may open the WebSocket: only pages of this server may. A client without an Origin is
/// no browser (a test, a script); it is allowed, but still needs the token.
[[nodiscard]] bool is_own_origin(std::string_view origin, std::string_view host_header);

}  // namespace ligature::host::view
