#pragma once
// Lists of the members of classes whose objects are saved in an image (image.hpp).

#include <tuple>

/// Lists all members of a class, in the order of their declaration, at the public end of the class. A member that is
/// added to the class does not compile until it is listed here too. A class of which not all members are saved has a
/// function members() of its own instead, which names all of them and returns those that are saved.
#define LIGATURE_MEMBERS(Type, ...)                        \
  [[nodiscard]] static auto members(Type& self) noexcept { \
    auto& [__VA_ARGS__] = self;                            \
    return std::tie(__VA_ARGS__);                          \
  }
