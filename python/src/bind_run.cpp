// Binds Run: the results of a script.

#include "python/src/arrays.hpp"
#include "python/src/bindings.hpp"
#include "python/src/run.hpp"

namespace ligature::python {
namespace {

using RunSelf = nb::pointer_and_handle<Run>;

/// Arrays that view a run's memory and keep the run alive.
auto trace_of(const RunSelf& self) {
  return View<double, nb::shape<-1, Run::kColumns>>(self.p->trace.data(),
                                                    {self.p->trace.size() / Run::kColumns, Run::kColumns}, self.h);
}
auto shape_t_s_of(const RunSelf& self) {
  return View<double, nb::ndim<1>>(self.p->shape_t_s.data(), {self.p->shape_t_s.size()}, self.h);
}
auto shapes_of(const RunSelf& self) {
  return View<double, nb::shape<-1, -1, 3>>(self.p->shapes.data(), {self.p->shape_t_s.size(), self.p->nodes, 3},
                                            self.h);
}

}  // namespace

void bind_run(nb::module_& module) {
  nb::class_<Run>(module, "_Run")
      .def_prop_ro("trace", &trace_of, "ticks x 12, read-only: the columns of trace.csv but for the last, step_us.")
      .def_prop_ro("shape_t_s", &shape_t_s_of, "k times, s.")
      .def_prop_ro("shapes", &shapes_of, "k x nodes x 3, m, read-only: the thread at shape_t_s.")
      .def_ro("finite", &Run::finite, "False: the run ended before its time, at a tick that is no number.")
      .def_prop_ro(
          "failure", [](const Run& r) { return text_of(r.failure); }, "Empty, or one line: tick, node, likely cause.");
}

}  // namespace ligature::python
