#pragma once
// What may cross a thread: plain values that can be copied byte by byte and never throw.

#include <concepts>
#include <type_traits>

namespace ligature::rt {

/// A value that a wait-free container may copy while another thread lives on: no owner, no pointer chasing, no
/// exception. Eigen's fixed vectors are not trivially copyable, so payloads hold std::array.
template <class T>
concept Payload = std::is_trivially_copyable_v<T> && std::is_nothrow_default_constructible_v<T>;

}  // namespace ligature::rt
