#include "host/mcap/writer.hpp"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <limits>

#include "host/errors.hpp"
#include "host/mcap/records.hpp"
#include "protocol/recorder/crc32.hpp"

namespace ligature::host::mcap {
namespace {

constexpr std::size_t kChunkBytes = 2U << 20U;
// Zstandard's level 1 packs the repeated keys nearly as well as higher levels, in a fraction of their time.
constexpr int kLevel = 1;
constexpr const char* kCompression = "zstd";

std::uint32_t crc_of(std::string_view bytes) {
  return recorder::crc32(std::as_bytes(std::span(bytes.data(), bytes.size())));
}

}  // namespace

/// Messages that are not written yet.
struct Writer::Chunk {
  Chunk() {
    if (!context) throw RunFailed("no memory for compression");
    ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kLevel);
    ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);  // readers of Zstandard check it by themselves
  }
  std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context{ZSTD_createCCtx(), &ZSTD_freeCCtx};
  std::string records, packed;
  std::uint64_t first_ns = std::numeric_limits<std::uint64_t>::max(), last_ns = 0;
  std::map<std::uint16_t, std::string> index;  // per channel: times and offsets of its messages

  void clear() {
    records.clear();
    index.clear();
    first_ns = std::numeric_limits<std::uint64_t>::max();
    last_ns = 0;
  }
};

struct Writer::Totals {
  std::map<std::uint16_t, std::uint64_t> messages;  // per channel
  std::uint32_t attachments = 0, metadata = 0, chunks = 0;
  std::uint64_t first_ns = std::numeric_limits<std::uint64_t>::max(), last_ns = 0;
};

Writer::Writer(const std::string& path, const std::string& library)
    : file_(path), chunk_(std::make_unique<Chunk>()), totals_(std::make_unique<Totals>()) {
  std::string header;
  put_text(header, "");  // no profile
  put_text(header, library);
  put(std::string(kMagic) + record(Op::kHeader, header));
}

Writer::~Writer() = default;

void Writer::put(const std::string& bytes) {
  file_.write(bytes);
  position_ += bytes.size();
}

std::uint16_t Writer::add_channel(const std::string& topic, const std::string& schema_name, const std::string& schema) {
  const auto number = static_cast<std::uint16_t>(totals_->messages.size() + 1);  // 0 would mean: no schema
  totals_->messages[number] = 0;
  std::string content;
  put_number(content, number);
  put_text(content, schema_name);
  put_text(content, "jsonschema");
  put_text(content, schema);
  schemas_ += record(Op::kSchema, content);
  put(record(Op::kSchema, content));
  content.clear();
  put_number(content, number);
  put_number(content, number);
  put_text(content, topic);
  put_text(content, "json");
  put_number(content, std::uint32_t{0});  // no metadata
  channels_ += record(Op::kChannel, content);
  put(record(Op::kChannel, content));
  return number;
}

void Writer::add_message(std::uint16_t channel, std::uint64_t time_ns, std::string_view data) {
  constexpr std::size_t kHeadBytes = 2 + 4 + 8 + 8;
  auto& index = chunk_->index[channel];
  put_number(index, time_ns);
  put_number(index, static_cast<std::uint64_t>(chunk_->records.size()));
  std::string& to = chunk_->records;
  put_record_head(to, Op::kMessage, kHeadBytes + data.size());
  put_number(to, channel);
  put_number(to, static_cast<std::uint32_t>(totals_->messages[channel]++));
  put_number(to, time_ns);  // logged
  put_number(to, time_ns);  // published
  to += data;
  chunk_->first_ns = std::min(chunk_->first_ns, time_ns);
  chunk_->last_ns = std::max(chunk_->last_ns, time_ns);
  if (to.size() >= kChunkBytes) end_chunk();
}

void Writer::end_chunk() {
  if (chunk_->records.empty()) return;
  const std::string& raw = chunk_->records;
  std::string& packed = chunk_->packed;
  packed.resize(ZSTD_compressBound(raw.size()));
  const std::size_t bytes = ZSTD_compress2(chunk_->context.get(), packed.data(), packed.size(), raw.data(), raw.size());
  if (ZSTD_isError(bytes)) throw RunFailed(file_.path() + ": compression failed: " + ZSTD_getErrorName(bytes));
  packed.resize(bytes);
  std::string content;
  put_number(content, chunk_->first_ns);
  put_number(content, chunk_->last_ns);
  put_number(content, static_cast<std::uint64_t>(raw.size()));
  put_number(content, std::uint32_t{0});  // no CRC of the raw bytes: Zstandard's own checksum covers them
  put_text(content, kCompression);
  put_number(content, static_cast<std::uint64_t>(packed.size()));
  content += packed;
  const std::uint64_t chunk_at = position_;
  put(record(Op::kChunk, content));
  const std::uint64_t index_at = position_;
  std::string places;
  for (const auto& [channel, entries] : chunk_->index) {
    put_number(places, channel);
    put_number(places, position_);
    content.clear();
    put_number(content, channel);
    put_text(content, entries);
    put(record(Op::kMessageIndex, content));
  }
  content.clear();
  put_number(content, chunk_->first_ns);
  put_number(content, chunk_->last_ns);
  put_number(content, chunk_at);
  put_number(content, index_at - chunk_at);
  put_text(content, places);
  put_number(content, position_ - index_at);
  put_text(content, kCompression);
  put_number(content, static_cast<std::uint64_t>(packed.size()));
  put_number(content, static_cast<std::uint64_t>(raw.size()));
  chunk_index_ += record(Op::kChunkIndex, content);
  totals_->first_ns = std::min(totals_->first_ns, chunk_->first_ns);
  totals_->last_ns = std::max(totals_->last_ns, chunk_->last_ns);
  ++totals_->chunks;
  chunk_->clear();
}

void Writer::add_attachment(const std::string& name, const std::string& media_type, std::uint64_t time_ns,
                            std::string_view data) {
  std::string content;
  put_number(content, time_ns);
  put_number(content, std::uint64_t{0});  // time of creation: not known
  put_text(content, name);
  put_text(content, media_type);
  put_number(content, static_cast<std::uint64_t>(data.size()));
  content += data;
  put_number(content, crc_of(content));
  const std::string whole = record(Op::kAttachment, content);
  std::string entry;
  put_number(entry, position_);
  put_number(entry, static_cast<std::uint64_t>(whole.size()));
  put_number(entry, time_ns);
  put_number(entry, std::uint64_t{0});
  put_number(entry, static_cast<std::uint64_t>(data.size()));
  put_text(entry, name);
  put_text(entry, media_type);
  attachment_index_ += record(Op::kAttachmentIndex, entry);
  ++totals_->attachments;
  put(whole);
}

void Writer::add_metadata(const std::string& name, const Pairs& pairs) {
  std::string map;
  for (const auto& [key, value] : pairs) {
    put_text(map, key);
    put_text(map, value);
  }
  std::string content;
  put_text(content, name);
  put_text(content, map);
  const std::string whole = record(Op::kMetadata, content);
  std::string entry;
  put_number(entry, position_);
  put_number(entry, static_cast<std::uint64_t>(whole.size()));
  put_text(entry, name);
  metadata_index_ += record(Op::kMetadataIndex, entry);
  ++totals_->metadata;
  put(whole);
}

void Writer::write_summary() {
  const Totals& totals = *totals_;
  std::string counts, statistics;
  std::uint64_t all = 0;
  for (const auto& [channel, count] : totals.messages) {
    put_number(counts, channel);
    put_number(counts, count);
    all += count;
  }
  put_number(statistics, all);
  put_number(statistics, static_cast<std::uint16_t>(totals.messages.size()));  // schemas
  put_number(statistics, static_cast<std::uint32_t>(totals.messages.size()));  // channels
  put_number(statistics, totals.attachments);
  put_number(statistics, totals.metadata);
  put_number(statistics, totals.chunks);
  put_number(statistics, all > 0 ? totals.first_ns : std::uint64_t{0});
  put_number(statistics, totals.last_ns);
  put_text(statistics, counts);

  const std::uint64_t summary_at = position_;
  std::string summary, offsets;
  const std::string statistics_record = record(Op::kStatistics, statistics);
  for (const auto& [op, group] :
       std::array<std::pair<Op, const std::string*>, 6>{{{Op::kSchema, &schemas_},
                                                         {Op::kChannel, &channels_},
                                                         {Op::kStatistics, &statistics_record},
                                                         {Op::kChunkIndex, &chunk_index_},
                                                         {Op::kAttachmentIndex, &attachment_index_},
                                                         {Op::kMetadataIndex, &metadata_index_}}}) {
    if (group->empty()) continue;
    std::string content;
    content += static_cast<char>(op);
    put_number(content, summary_at + summary.size());
    put_number(content, static_cast<std::uint64_t>(group->size()));
    offsets += record(Op::kSummaryOffset, content);
    summary += *group;
  }
  const std::uint64_t offsets_at = summary_at + summary.size();
  constexpr std::uint64_t kFooterBytes = 8 + 8 + 4;
  std::string tail = summary + offsets;
  put_record_head(tail, Op::kFooter, kFooterBytes);
  put_number(tail, summary_at);
  put_number(tail, offsets_at);
  put_number(tail, crc_of(tail));
  put(tail + std::string(kMagic));
}

void Writer::commit() {
  end_chunk();
  std::string end;
  put_number(end, std::uint32_t{0});  // no CRC of the data: each chunk has its own
  put(record(Op::kDataEnd, end));
  write_summary();
  file_.commit();
}

}  // namespace ligature::host::mcap
