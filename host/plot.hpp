#pragma once
#include <string>

namespace ligature::host {

/// Draws the forces of a log by plots/plot_forces.py.
/// The Python is $LIGATURE_PYTHON, else the one this program was configured with.
/// @param by_frame against the number of the haptic frame instead of time, as the paper's Table III.
/// @throws BadInput when there is no such Python or the log is none, RunFailed when drawing fails.
void plot(const std::string& log_path, const std::string& out_path, bool by_frame);

/// Draws the thread's last shape by plots/plot_thread.py, its knot magnified and named. @throws as plot().
void plot_thread(const std::string& log_path, const std::string& out_path);

/// Draws the forces of two logs over each other and prints what differs. @param align "start": both from their first
/// tick; "grasp": both from their first grasp. @param shift_s moves the second one later.
void plot_comparison(const std::string& log_a, const std::string& log_b, const std::string& out_path,
                     const std::string& align, double shift_s);

}  // namespace ligature::host
