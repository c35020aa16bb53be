#pragma once
// Functions that add classes and functions to the Python module, one for each bind_*.cpp.

#include <nanobind/nanobind.h>

#include <string_view>

namespace ligature::python {

/// Converts bytes to a Python string; invalid UTF-8 becomes a replacement character.
inline nanobind::str text_of(std::string_view bytes) {
  return nanobind::steal<nanobind::str>(
      PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()), "replace"));
}

void bind_scene(nanobind::module_& module);
void bind_run(nanobind::module_& module);
void bind_simulation(nanobind::module_& module);
void bind_knot(nanobind::module_& module);
void bind_recording(nanobind::module_& module);
void bind_rerun(nanobind::module_& module);
void bind_rig(nanobind::module_& module);

}  // namespace ligature::python
