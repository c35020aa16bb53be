#pragma once
// Decodes a message from its .lcm definition alone, without generated code, so that a field that the program under test
// forgets is still found.

#include <array>
#include <bit>
#include <cstdint>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "ligature_source_dir.hpp"

namespace ligature::test {

struct LcmField {
  std::string type, name;
  std::vector<std::string> sizes;  // array sizes: a number, or the name of the field that holds it
};

/// The fields of protocol/lcm/TYPE.lcm, in order.
inline std::vector<LcmField> lcm_fields(const std::string& type) {
  std::ifstream file(LIGATURE_SOURCE_DIR "/protocol/lcm/" + type + ".lcm");
  std::ostringstream all;
  all << file.rdbuf();
  const std::string text = std::regex_replace(all.str(), std::regex("//[^\n]*"), "");
  const std::regex field(R"((\w+)\s+(\w+)((?:\s*\[\w+\])*)\s*;)"), size(R"(\[(\w+)\])");
  std::vector<LcmField> found;
  const auto body = text.substr(text.find('{'));
  for (std::sregex_iterator it(body.begin(), body.end(), field), end; it != end; ++it) {
    LcmField one{(*it)[1], (*it)[2], {}};
    const std::string sizes = (*it)[3];
    for (std::sregex_iterator s(sizes.begin(), sizes.end(), size); s != end; ++s) one.sizes.push_back((*s)[1]);
    found.push_back(one);
  }
  if (found.empty()) throw std::runtime_error("no fields in " + type + ".lcm");
  return found;
}

/// A value as text; two texts are equal exactly if the values' bits are.
inline std::string word(const std::string& value) { return value; }
template <class T>
std::string word(T value) {
  std::ostringstream out;
  out.precision(17);
  if constexpr (sizeof(T) == 1)
    out << static_cast<int>(value);
  else
    out << value;
  return out.str();
}

using Words = std::vector<std::string>;
template <class... T>
Words words(const T&... values) {
  return {word(values)...};
}

/// All fields of an encoded message (hash included) by name, arrays flattened. @throws when the definition needs more
/// or fewer bytes than the message has.
template <class M>
std::map<std::string, Words> told(const M& message, const std::string& type) {
  std::vector<unsigned char> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  std::size_t at = 8;  // after the hash
  const auto number = [&](std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value = value << 8U | bytes.at(at++);
    return value;
  };
  const auto one = [&](const std::string& kind) -> std::string {
    if (kind == "int8_t") return word(static_cast<std::int8_t>(number(1)));
    if (kind == "int16_t") return word(static_cast<std::int16_t>(number(2)));
    if (kind == "int32_t") return word(static_cast<std::int32_t>(number(4)));
    if (kind == "int64_t") return word(static_cast<std::int64_t>(number(8)));
    if (kind == "float") return word(std::bit_cast<float>(static_cast<std::uint32_t>(number(4))));
    if (kind == "double") return word(std::bit_cast<double>(number(8)));
    if (kind != "string") throw std::runtime_error("no such type here: " + kind);
    std::string text;
    for (auto left = number(4); left > 1; --left) text += static_cast<char>(number(1));
    (void)number(1);
    return text;
  };
  std::map<std::string, Words> found;
  for (const LcmField& field : lcm_fields(type)) {
    std::size_t count = 1;
    for (const auto& size : field.sizes) count *= std::stoul(found.contains(size) ? found[size].at(0) : size);
    auto& values = found[field.name];
    for (std::size_t i = 0; i < count; ++i) values.push_back(one(field.type));
  }
  if (at != bytes.size()) throw std::runtime_error(type + ": bytes that no field has");
  return found;
}

}  // namespace ligature::test
