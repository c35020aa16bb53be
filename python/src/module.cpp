// The module ligature._core: physics of the thread, scenes, knots and recordings, as in the programs.

#include <nanobind/nanobind.h>

#include <algorithm>
#include <string>

#include "host/errors.hpp"
#include "host/lab/outcome.hpp"
#include "python/src/bindings.hpp"

namespace nb = nanobind;

namespace {

PyObject* g_refusal = nullptr;

/// Translates the programs' exceptions to Python exceptions with the same message.
void translate(const std::exception_ptr& thrown, void*) {
  namespace python = ligature::python;
  const auto raise = [](PyObject* type, std::string line) {  // replaces line breaks, so that the message is one line
    std::ranges::replace(line, '\n', ' ');
    PyErr_SetObject(type, python::text_of(line).ptr());
  };
  try {
    std::rethrow_exception(thrown);
  } catch (const ligature::lab::Refusal& error) {
    raise(g_refusal, error.what());
  } catch (const ligature::host::BadInput& error) {
    raise(g_refusal, error.what());
  } catch (const ligature::host::RunFailed& error) {
    raise(PyExc_OSError, error.what());
  }
}

}  // namespace

NB_MODULE(_core, module) {
  namespace python = ligature::python;
  module.attr("__version__") = LIGATURE_VERSION;
  g_refusal = PyErr_NewExceptionWithDoc(
      "ligature.Refusal",
      "Raised for invalid input: one line that names the place, what was found and what is allowed.", PyExc_ValueError,
      nullptr);
  module.attr("Refusal") = nb::handle(g_refusal);
  nb::register_exception_translator(translate);
  python::bind_scene(module);
  python::bind_run(module);
  python::bind_simulation(module);
  python::bind_knot(module);
  python::bind_recording(module);
  python::bind_rerun(module);
  python::bind_rig(module);
}
