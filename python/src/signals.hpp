#pragma once
// Lets Python react to signals (Ctrl-C) while C++ runs without the GIL.

#include <nanobind/nanobind.h>

#include <chrono>
#include <optional>
#include <utility>

namespace ligature::python {

/// Lets Python handle signals every 50 ms; returns false once a handler has raised an exception (Ctrl-C).
class Signals {
 public:
  bool operator()() {
    const auto now = Clock::now();
    if (now < due_) return true;
    due_ = now + std::chrono::milliseconds(50);
    const nanobind::gil_scoped_acquire lock;
    raised_ = raised_ || PyErr_CheckSignals() != 0;
    if (raised_ && !error_ && PyErr_Occurred()) error_.emplace();
    return !raised_;
  }
  /// Rethrows the exception that a Python signal handler has raised. The caller must hold the GIL.
  void rethrow() {
    if (error_) throw nanobind::python_error(std::move(*error_));
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point due_ = Clock::now() + std::chrono::milliseconds(50);
  bool raised_ = false;
  std::optional<nanobind::python_error> error_;
};

}  // namespace ligature::python
