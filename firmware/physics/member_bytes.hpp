#pragma once
// Writes and reads the contents of an image: every listed member (members.hpp) of an object, one after the other.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#include "firmware/physics/image.hpp"
#include "firmware/physics/members.hpp"

namespace ligature::physics {

/// A class with a list of its members.
template <class T>
concept Listed = requires(T& object) {
  T::members(object);
};
/// A class with a large array that is only partly in use. in_use() returns the used part, whose length follows from the
/// listed members.
template <class T>
concept PartlyUsed = requires(T& object) {
  object.in_use();
};

/// Visits every number in an object, in a fixed order. The base class Bytes is ImageWriter or ImageReader: its raw(at,
/// size) writes or reads numbers, its size(vector) the length of a vector. A type without a list of its members does
/// not compile.
template <class Bytes>
class ImageOf : public Bytes {
 public:
  using Bytes::Bytes;

  template <class T>
  void visit(T& value) {
    if constexpr (Listed<T>) {
      std::apply([this](auto&... member) { (this->visit(member), ...); }, T::members(value));
      if constexpr (PartlyUsed<T>) numbers(value.in_use());
    } else {
      static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>,
                    "give this class a list of its members (members.hpp)");
      Bytes::raw(&value, sizeof value);
    }
  }
  void visit(double __attribute__((vector_size(32))) & lanes) { Bytes::raw(&lanes, sizeof lanes); }
  void visit(Eigen::Vector3d& vector) { Bytes::raw(vector.data(), 3 * sizeof(double)); }
  template <class T, std::size_t N>
  void visit(T (&array)[N]) {
    for (T& each : array) visit(each);
  }
  template <class T, std::size_t N>
  void visit(std::array<T, N>& array) {
    for (T& each : array) visit(each);
  }
  template <class A, class B>
  void visit(std::pair<A, B>& pair) {
    visit(pair.first), visit(pair.second);
  }
  template <class T>
  void visit(std::optional<T>& value) {
    bool has = value.has_value();
    visit(has);
    if (has && !value) value.emplace();
    if (!has) value.reset();
    if (value) visit(*value);
  }
  template <class Vector>
  requires std::is_base_of_v<std::vector<typename Vector::value_type>, Vector>
  void visit(Vector& vector) {
    Bytes::size(vector);
    if constexpr (std::is_arithmetic_v<typename Vector::value_type>) {
      numbers(std::span(vector));
    } else {
      for (auto& each : vector) visit(each);
    }
  }

 private:
  template <class T>
  void numbers(std::span<T> all) {
    Bytes::raw(all.data(), all.size_bytes());
  }
};

class ImageWriter {
 public:
  explicit ImageWriter(ImageBytes& out) : out_(out) {}

 protected:
  void raw(const void* at, std::size_t size) {
    const auto* const bytes = static_cast<const std::byte*>(at);
    out_.insert(out_.end(), bytes, bytes + size);
  }
  void size(const auto& vector) {
    const std::uint64_t count = vector.size();
    raw(&count, sizeof count);
  }

 private:
  ImageBytes& out_;
};

/// Reads an image into an object that was made from the same scene. So an image in which a vector exceeds its capacity
/// is wrong.
class ImageReader {
 public:
  explicit ImageReader(std::span<const std::byte> image) : rest_(image) {}
  /// Was the image exactly as long as the object needs?
  [[nodiscard]] bool is_complete() const noexcept { return fits_ && rest_.empty(); }

 protected:
  void raw(void* at, std::size_t size) {
    fits_ = fits_ && size <= rest_.size();
    if (!fits_ || size == 0) return;
    std::memcpy(at, rest_.data(), size);
    rest_ = rest_.subspan(size);
  }
  void size(auto& vector) {
    std::uint64_t count = 0;
    raw(&count, sizeof count);
    fits_ = fits_ && count <= vector.capacity();
    if (fits_) vector.resize(count);
  }

 private:
  std::span<const std::byte> rest_;
  bool fits_ = true;
};

/// Appends to `text` the names of the types of all members of a class, and of their members, in the order of an image.
/// So a build with other members makes another text.
template <class T>
void add_layout(std::string& text) {
  if constexpr (Listed<T>) {
    using Members = decltype(T::members(std::declval<T&>()));
    text += typeid(Members).name();
    [&]<class... M>(std::type_identity<std::tuple<M&...>>) {
      (add_layout<M>(text), ...);
    }(std::type_identity<Members>{});
  } else if constexpr (requires { typename T::value_type; }) {
    add_layout<typename T::value_type>(text);
  }
}

}  // namespace ligature::physics
