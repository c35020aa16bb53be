#pragma once
// Types that may be passed between threads: plain values.

#include <concepts>
#include <type_traits>

namespace ligature::rt {

/// A type that a wait-free container may copy byte by byte: trivially copyable, no exceptions. Eigen's fixed-size
/// vectors are not trivially copyable, so payloads use std::array.
template <class T>
concept Payload = std::is_trivially_copyable_v<T> && std::is_nothrow_default_constructible_v<T>;

}  // namespace ligature::rt
