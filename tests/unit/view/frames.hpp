#pragma once
// Decodes the binary frames that the host sends to the web page, as the page does.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "host/view/frame.hpp"
#include "host/view/trace_row.hpp"

namespace ligature::host::view::test_frames {

struct Read {
  std::uint32_t number = 0;
  std::map<Section, std::vector<std::byte>> sections;

  explicit Read(const std::vector<std::byte>& bytes) {
    std::memcpy(&number, bytes.data() + 4, 4);
    for (std::size_t at = 8; at + 8 <= bytes.size();) {
      std::uint32_t kind = 0, size = 0;
      std::memcpy(&kind, bytes.data() + at, 4);
      std::memcpy(&size, bytes.data() + at + 4, 4);
      const auto* start = bytes.data() + at + 8;
      sections[static_cast<Section>(kind)].assign(start, start + size);
      at += 8 + (size + 7) / 8 * 8;
    }
  }
  [[nodiscard]] std::vector<double> doubles(Section section) const {
    if (!sections.contains(section)) return {};
    const auto& bytes = sections.at(section);
    std::vector<double> values(bytes.size() / sizeof(double));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(double));
    return values;
  }
  [[nodiscard]] nlohmann::json text() const {
    if (!sections.contains(Section::kText)) return nlohmann::json::object();
    const auto& bytes = sections.at(Section::kText);
    return nlohmann::json::parse(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  }
  [[nodiscard]] std::vector<std::int64_t> ticks() const {
    std::vector<std::int64_t> found;
    const auto rows = doubles(Section::kRows);
    for (std::size_t i = 0; i < rows.size(); i += kColumns) found.push_back(static_cast<std::int64_t>(rows[i]));
    return found;
  }
  /// Numbers of the trace bins (summaries of some ticks each) in the frame.
  [[nodiscard]] std::vector<std::int64_t> bins() const {
    std::vector<std::int64_t> found;
    if (!sections.contains(Section::kBins)) return found;
    const auto& bytes = sections.at(Section::kBins);
    for (std::size_t at = 0; at + sizeof(TraceBin) <= bytes.size(); at += sizeof(TraceBin)) {
      TraceBin bin;
      std::memcpy(&bin, bytes.data() + at, sizeof bin);
      found.push_back(static_cast<std::int64_t>(bin.low[kTick]) +
                      static_cast<std::int64_t>(bin.high[kTick]) * kBinNumberPart);
    }
    return found;
  }
};

}  // namespace ligature::host::view::test_frames
