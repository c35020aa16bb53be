#pragma once
// Writes MCAP files (https://mcap.dev/spec): messages in chunks compressed by Zstandard, and an index at the end, so
// that viewers can jump to any time.

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/atomic_file.hpp"

namespace ligature::host::mcap {

using Pairs = std::vector<std::pair<std::string, std::string>>;

class Writer {
 public:
  /// @throws BadInput when the file cannot be created.
  Writer(const std::string& path, const std::string& library);
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// A topic of JSON messages with their JSON schema. @return its number, for add_message().
  std::uint16_t add_channel(const std::string& topic, const std::string& schema_name, const std::string& schema);
  void add_message(std::uint16_t channel, std::uint64_t time_ns, std::string_view data);
  void add_attachment(const std::string& name, const std::string& media_type, std::uint64_t time_ns,
                      std::string_view data);
  void add_metadata(const std::string& name, const Pairs& pairs);
  /// Writes the index and gives the file its name. @throws RunFailed.
  void commit();

 private:
  struct Chunk;
  struct Totals;
  void put(const std::string& bytes);
  void end_chunk();
  void write_summary();

  AtomicFile file_;
  std::uint64_t position_ = 0;
  std::string channels_, chunk_index_, attachment_index_, metadata_index_;  // records that the summary repeats
  std::string schemas_;
  std::unique_ptr<Chunk> chunk_;
  std::unique_ptr<Totals> totals_;
};

}  // namespace ligature::host::mcap
