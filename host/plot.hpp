#pragma once
#include <string>

namespace ligature::host {

/// Draws the forces of a log by plots/plot_forces.py.
/// The Python is $LIGATURE_PYTHON, else the one this program was configured with.
/// @throws BadInput when there is no such Python or the log is none, RunFailed when drawing fails.
void plot(const std::string& log_path, const std::string& out_path);

}  // namespace ligature::host
