#pragma once
#include <string>
#include <vector>

namespace ligature::host {

/// Draws the forces of a log with plots/plot_forces.py.
/// Python is $LIGATURE_PYTHON, else the one that this program was configured with.
/// @param by_frame horizontal axis: number of the haptic frame instead of time, as in the paper's Table III.
/// @throws BadInput without such a Python or when the file is no log, RunFailed when drawing fails.
void plot(const std::string& log_path, const std::string& out_path, bool by_frame);

/// Draws the thread's last shape with plots/plot_thread.py, with its knot magnified and named. @throws as plot().
void plot_thread(const std::string& log_path, const std::string& out_path);

/// Draws the forces of two logs in one diagram and prints their differences. @param align what time 0 is: "start", the
/// first tick of each log; "grasp", its first grasp; a log without one is refused (BadInput). @param shift_s delays the
/// second log by this time.
void plot_comparison(const std::string& log_a, const std::string& log_b, const std::string& out_path,
                     const std::string& align, double shift_s);

/// Draws the wake-up latencies of reports of `ligature-firmware doctor --report` with plots/plot_latency.py. @throws as
/// plot(); BadInput names the file that is no report, or one without a measurement.
void plot_latency(const std::vector<std::string>& reports, const std::string& out_path);

}  // namespace ligature::host
