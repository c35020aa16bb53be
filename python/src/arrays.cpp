#include "python/src/arrays.hpp"

namespace ligature::python {

std::span<const double> rows_of(const Numbers& array, const char* name, std::size_t columns, double most) {
  if (array.ndim() != 2 || array.shape(1) != columns) {
    std::string found;
    for (std::size_t i = 0; i < array.ndim(); ++i) found += (i ? " x " : "") + std::to_string(array.shape(i));
    throw lab::Refusal(std::string(name) + ": found " + (found.empty() ? "a number" : "an array of " + found) +
                       ", allowed n x " + std::to_string(columns));
  }
  const std::span<const double> values(array.data(), array.shape(0) * columns);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::abs(values[i]) <= most) continue;  // false for nan, too
    char text[120];
    std::snprintf(text, sizeof text, ": row %zu, column %zu: found %g, allowed -%g .. %g", i / columns, i % columns,
                  values[i], most, most);
    throw lab::Refusal(name + std::string(text));
  }
  return values;
}

}  // namespace ligature::python
