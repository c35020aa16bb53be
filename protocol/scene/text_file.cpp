#include "protocol/scene/text_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace ligature::scene {
namespace {

/// Reads up to that many bytes of an open file. @return the text, or the errno.
std::variant<std::string, int> all_of(int fd, std::size_t most_bytes) {
  std::string text(most_bytes, '\0');
  std::size_t done = 0;
  while (done < text.size()) {
    const auto n = ::read(fd, text.data() + done, text.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    if (n == 0) break;
    done += static_cast<std::size_t>(n);
  }
  text.resize(done);
  text.shrink_to_fit();
  return text;
}

}  // namespace

std::variant<std::string, Error> read_text(const std::filesystem::path& path, std::size_t most_bytes) {
  const auto refused = [&](const std::string& why) { return Error{path.string() + ": " + why}; };
  // Without O_NONBLOCK, opening a pipe would wait for its writer, possibly forever.
  const int fd = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (fd < 0) return refused(std::string("cannot be read: ") + std::strerror(errno));
  struct stat found {};
  const bool known = fstat(fd, &found) == 0;
  if (!known || !S_ISREG(found.st_mode)) {
    ::close(fd);
    return refused(known && S_ISDIR(found.st_mode) ? "cannot be read: Is a directory"
                                                   : "cannot be read: found a pipe or device, allowed a regular file");
  }
  const auto size = static_cast<std::size_t>(found.st_size);
  // One byte more than expected reveals a file that is too long or growing
  auto read = all_of(fd, std::min(size, most_bytes) + 1);
  ::close(fd);
  if (const int* error = std::get_if<int>(&read))
    return refused(std::string("cannot be read: ") + std::strerror(*error));
  auto& text = std::get<std::string>(read);
  if (text.size() > most_bytes || size > most_bytes)
    return refused("found " + std::to_string(std::max(size, text.size())) + " bytes, allowed " +
                   std::to_string(most_bytes) + " at most");
  return std::move(text);
}

}  // namespace ligature::scene
