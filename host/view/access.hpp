#pragma once
#include <string>
#include <string_view>

namespace ligature::host::view {

/// Who may see, and who may command.
struct Access {
  std::string token;         // empty: nobody commands
  bool gives_token = false;  // the page itself carries it: only when nobody but this machine can ask for the page
};

/// 128 random bits in hexadecimal. @throws RunFailed when the kernel gives none.
[[nodiscard]] std::string make_token();

/// First line of a file, at least 16 printable characters. @throws BadInput.
[[nodiscard]] std::string read_token_file(const std::string& path);

/// Equal, in a time that does not tell where they differ; false for an empty expected token.
[[nodiscard]] bool is_token(std::string_view found, std::string_view expected) noexcept;

/// Why what came with this token is not done; empty when it is.
[[nodiscard]] std::string objection_to(std::string_view token, const Access& access);

/// Whether a Host header names this machine by address, as localhost or by its own name. A page of another site that
/// points its own name at 127.0.0.1 (DNS rebinding) comes with that name and is turned away.
[[nodiscard]] bool is_own_host(std::string_view host_header, std::string_view machine_name);

/// Whether a page of this Origin may open our WebSocket: only pages of this very server. No Origin at all is no
/// browser (a test, a script), which can read the token as little as anybody else.
[[nodiscard]] bool is_own_origin(std::string_view origin, std::string_view host_header);

}  // namespace ligature::host::view
