#pragma once
// A TOML table that is read key by key and refuses keys that were not read. It can also list the keys. Private to the
// readers of scene, device and fault files, because including it compiles toml++.

// Disables the parser's assertions: one fails on a zero byte in a key (found by fuzzing), although the parser then
// refuses it.
#define TOML_ASSERT(expr) static_assert(true)
#include <toml++/toml.h>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "protocol/scene/csv.hpp"
#include "protocol/scene/key_list.hpp"
#include "protocol/scene/scene.hpp"

namespace ligature::scene {

/// Overrides in force, and the first error; values read after an error are ignored.
struct ReadContext {
  std::string file;
  std::map<std::string, std::string> overridden;  ///< dotted key -> text of its --set
  std::optional<Error> error;
  /// If set, every key that a reader asks for is appended to it, also keys of absent tables, and a missing key is no
  /// error.
  std::vector<KeyRow>* listed = nullptr;

  [[nodiscard]] bool is_overridden(const std::string& key) const { return overridden.contains(root_of(key)); }

  /// @param between_keys  whether a rule between several keys is broken. Then an override may be the cause, so the
  /// message also lists the overrides
  void refuse(const std::string& key, const toml::node& where, const std::string& what, bool between_keys = false) {
    if (error) return;
    auto set = overridden.find(root_of(key));
    if (set == overridden.end() && where.source().begin.line == 0) {  // a table that exists only by an override
      set = overridden.lower_bound(key + ".");
    }
    const auto place =
        set != overridden.end() ? "--set " + set->second : file + ":" + std::to_string(where.source().begin.line);
    std::string with;
    for (const auto& [_, text] : overridden)
      if (between_keys && set == overridden.end()) with += (with.empty() ? "; with --set " : " --set ") + text;
    error = Error{place + ": " + what + with};
  }

 private:
  /// The override that contains `key`: the same key, or a prefix that ends before a dot or bracket; `key` itself if
  /// there is none.
  [[nodiscard]] std::string root_of(const std::string& key) const {
    for (const auto& [prefix, text] : overridden) {
      const bool inside = key.size() > prefix.size() && key.starts_with(prefix) &&
                          (key[prefix.size()] == '.' || key[prefix.size()] == '[');
      if (inside) return prefix;
    }
    return key;
  }
};

/// Allowed range of a number, both ends included.
struct Range {
  double low;
  double high;

  [[nodiscard]] bool holds(double v) const { return v >= low && v <= high; }
  [[nodiscard]] std::string text() const {
    std::ostringstream s;
    s << low << " .. " << high;
    return s.str();
  }
};

class StrictTable {
 public:
  StrictTable(const toml::table& table, std::string path, ReadContext& context)
      : table_(table), path_(std::move(path)), context_(context) {}

  void number(std::string_view key, double& out, Range range) {
    if (lists()) list(key, "number " + range.text(), digits(out));
    const auto* node = take(key);
    if (!node) return;
    const auto value = node->value<double>();
    if (!node->is_number() || !value || !std::isfinite(*value) || !range.holds(*value)) {
      return refuse(key, *node, "number " + range.text());
    }
    out = *value;
  }

  void number(std::string_view key, std::optional<double>& out, Range range) {
    if (!table_.contains(key)) {
      if (lists()) list(key, "number " + range.text(), "none");
      return void(take(key));
    }
    double value = range.high;
    number(key, value, range);
    out = value;
  }

  void integer(std::string_view key, int& out, int low, int high) {
    if (lists()) list(key, whole(low, high), std::to_string(out));
    const auto* node = take(key);
    if (!node) return;
    const auto value = node->is_integer() ? node->value<std::int64_t>() : std::nullopt;
    if (!value || *value < low || *value > high) return refuse(key, *node, whole(low, high));
    out = static_cast<int>(*value);
  }

  void integer(std::string_view key, std::optional<int>& out, int low, int high) {
    if (!table_.contains(key)) {
      if (lists()) list(key, whole(low, high), "none");
      return void(take(key));
    }
    int value = low;
    integer(key, value, low, high);
    out = value;
  }

  void boolean(std::string_view key, bool& out) {
    if (lists()) list(key, "true or false", out ? "true" : "false");
    const auto* node = take(key);
    if (!node) return;
    const auto value = node->is_boolean() ? node->value<bool>() : std::nullopt;
    if (!value) return refuse(key, *node, "true or false");
    out = value.value();
  }

  void text(std::string_view key, std::string& out) {
    if (lists()) list(key, "a text", out.empty() ? "none" : "\"" + out + "\"");
    const auto* node = take(key);
    if (!node) return;
    const auto value = node->value<std::string>();
    if (!node->is_string() || !value || value->empty()) return refuse(key, *node, "a text");
    out = *value;
  }

  /// Reads a name from a table of {name, value}.
  template <class Enum, std::size_t N>
  void choice(std::string_view key, Enum& out, const std::pair<const char*, Enum> (&names)[N], const char* note = "") {
    std::string allowed, standard = "none";
    for (const auto& [label, value] : names) {
      const std::string quoted = "\"" + std::string(label) + "\"";
      allowed += (allowed.empty() ? "" : ", ") + quoted;
      if (value == out) standard = quoted;
    }
    if (lists()) list(key, "one of " + allowed + note, standard);
    const auto* node = take(key);
    if (!node) return;
    for (const auto& [label, value] : names) {
      if (node->is_string() && node->value<std::string>() == std::string(label)) return void(out = value);
    }
    refuse(key, *node, "one of " + allowed + note);
  }

  void vector(std::string_view key, Vec& out, double limit) {
    if (lists()) list(key, within(limit), "[" + digits(out[0]) + ", " + digits(out[1]) + ", " + digits(out[2]) + "]");
    const auto* node = take(key);
    if (!node) return;
    const auto* array = node->as_array();
    Vec v{};
    bool good = array && array->size() == 3;
    for (std::size_t i = 0; good && i < 3; ++i) {
      const auto value = (*array)[i].is_number() ? (*array)[i].value<double>() : std::nullopt;
      good = value && std::isfinite(*value) && std::abs(*value) <= limit;
      if (good) v[i] = *value;
    }
    if (!good) return refuse(key, *node, within(limit));
    out = v;
  }

  void vector(std::string_view key, std::optional<Vec>& out, double limit) {
    if (!table_.contains(key)) {
      if (lists()) list(key, within(limit), "none");
      return void(take(key));
    }
    Vec v{};
    vector(key, v, limit);
    out = v;
  }

  /// Calls read(StrictTable&) for the table under `key`, if present.
  template <class Read>
  void table(std::string_view key, Read read) {
    if (lists()) list(key, "a table", "none");
    const auto* node = take(key);
    if (!node) return list_inner(full(key), read);
    if (!node->is_table()) return refuse(key, *node, "a table");
    StrictTable inner(*node->as_table(), full(key), context_);
    read(inner);
    inner.finish();
  }

  /// Calls read(StrictTable&) for each table of the array under `key`, if present.
  template <class Read>
  void tables(std::string_view key, Read read) {
    const std::string kind = "an array of tables [{...}, ...]";
    if (lists()) list(key, kind, "none");
    const auto* node = take(key);
    if (!node) return list_inner(full(key) + "[]", read);
    const auto* array = node->as_array();
    for (std::size_t i = 0; array && i < array->size(); ++i) {
      if (!(*array)[i].is_table()) array = nullptr;
    }
    if (!array) return refuse(key, *node, kind);
    for (std::size_t i = 0; i < array->size(); ++i) {
      StrictTable inner(*(*array)[i].as_table(), full(key) + "[" + std::to_string(i) + "]", context_);
      read(inner);
      inner.finish();
    }
  }

  /// Reads keys that only `owner` uses, for example "suture.model \"rod\"". If the scene uses another model (`here` is
  /// false), such a key in the file is refused rather than silently ignored.
  template <class Read>
  void keys_of(bool here, const char* owner, Read read) {
    elsewhere_ = here ? nullptr : owner;
    owner_ = owner;
    read();
    elsewhere_ = nullptr;
    owner_.clear();
  }

  /// Refuses the table if a required key is missing.
  void require(std::string_view key) {
    if (lists()) return void(required_.emplace(key));
    if (!table_.contains(key))
      context_.refuse(path_, table_,
                      (path_.empty() ? "" : "'" + path_ + "': ") + "key '" + std::string(key) + "' is missing");
  }

  /// Refuses the first key in the file that was never read.
  void finish() {
    for (const auto& [key, node] : table_) {
      if (asked_.contains(std::string(key.str()))) continue;
      std::string allowed;
      for (const auto& k : asked_) allowed += (allowed.empty() ? "" : ", ") + k;
      const char* kind = node.is_table() ? "table" : "key";
      context_.refuse(full(key.str()), node,
                      std::string("unknown ") + kind + " '" + full(scene::shown(key.str())) + "', allowed " + allowed);
    }
  }

  void refuse(std::string_view key, const toml::node& node, const std::string& allowed, bool between_keys = false) {
    context_.refuse(full(key), node, "key '" + full(key) + "': found " + shown(node) + ", allowed " + allowed,
                    between_keys);
  }

  /// Refuses a key that breaks a rule between several keys; to be called after these were read.
  void refuse(std::string_view key, const std::string& allowed) {
    if (const auto* node = table_.get(key)) refuse(key, *node, allowed, true);
  }

  /// Is the key in the file?
  [[nodiscard]] bool has(std::string_view key) const { return table_.contains(key); }
  [[nodiscard]] bool was_overridden(std::string_view key) const { return context_.is_overridden(full(key)); }
  [[nodiscard]] bool failed() const { return context_.error.has_value(); }

 private:
  const toml::node* take(std::string_view key) {
    const auto* node = context_.error ? nullptr : table_.get(key);
    if (elsewhere_ == nullptr) {
      asked_.insert(std::string(key));
      return node;
    }
    if (node != nullptr) refuse(key, *node, std::string(elsewhere_) + " only", true);
    return nullptr;
  }
  [[nodiscard]] bool lists() const { return context_.listed != nullptr; }
  void list(std::string_view key, const std::string& allowed, const std::string& standard) {
    const bool required = required_.contains(std::string(key));
    context_.listed->push_back({full(key), allowed, required ? "required" : standard, owner_});
  }
  /// Lists the keys of an absent table.
  template <class Read>
  void list_inner(const std::string& path, Read read) {
    if (!lists()) return;
    const toml::table none;
    StrictTable inner(none, path, context_);
    inner.owner_ = owner_;
    read(inner);
  }
  static std::string whole(int low, int high) {
    return "integer " + std::to_string(low) + " .. " + std::to_string(high);
  }
  static std::string within(double limit) {
    std::ostringstream allowed;
    allowed << "three numbers [x, y, z], each -" << limit << " .. " << limit;
    return allowed.str();
  }
  static std::string digits(double value) {
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
  }
  [[nodiscard]] std::string full(std::string_view key) const {
    return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
  }
  /// The value found, on one line of at most 80 characters. Lists are written here value by value, because toml++'s own
  /// width estimate converts the negative logarithm of a value such as 0.05 to unsigned (found by fuzzing).
  static std::string shown(const toml::node& node) {
    std::string s;
    write(node, s);
    for (auto& c : s) {
      if (c == '\n' || c == '\r') c = ' ';
    }
    return s.size() > 80 ? s.substr(0, 77) + "..." : s;
  }
  static void write(const toml::node& node, std::string& out) {
    if (const auto* list = node.as_array()) {
      out += '[';
      for (const auto& each : *list) {
        if (out.size() > 80) break;
        if (&each != list->get(0)) out += ", ";
        write(each, out);
      }
      out += ']';
    } else if (node.is_table()) {
      out += "a table";
    } else if (const auto* number = node.as_floating_point()) {
      const std::string text = digits(number->get());
      out += text;
      // 50.0 is not shortened to 50: the message must show why it is no integer
      if (text.find_first_not_of("-0123456789") == std::string::npos) out += ".0";
    } else {
      std::ostringstream value;
      node.visit([&](const auto& v) { value << v; });
      out += value.str();
    }
  }

  const toml::table& table_;
  std::string path_;
  ReadContext& context_;
  std::set<std::string> asked_;
  std::set<std::string> required_;   ///< when listing: the keys that must be present
  std::string owner_;                ///< owner of the keys being read; empty: all models
  const char* elsewhere_ = nullptr;  ///< owner of the keys being read, if another model is used; else nullptr
};

}  // namespace ligature::scene
