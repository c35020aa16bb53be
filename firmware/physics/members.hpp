#pragma once
// Lists of the members of classes whose objects are saved in an image (image.hpp).

#include <tuple>

/// Lists all members of a class, in the order of their declaration, at the end of its public part. A class with a
/// member that is missing in its list does not compile. A class that saves only some of its members has its own
/// function members() instead, which names all members and returns those that are saved.
#define LIGATURE_MEMBERS(Type, ...)                        \
  [[nodiscard]] static auto members(Type& self) noexcept { \
    auto& [__VA_ARGS__] = self;                            \
    return std::tie(__VA_ARGS__);                          \
  }
