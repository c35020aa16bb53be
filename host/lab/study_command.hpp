#pragma once

#include <CLI/App.hpp>

namespace ligature::lab {

/// Adds `study`, which becomes the Python program ligature.study.
void add_study_command(CLI::App& app);

}  // namespace ligature::lab
