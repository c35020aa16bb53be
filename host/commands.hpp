#pragma once

namespace CLI {
class App;
}

namespace ligature::host {

/// Each adds one subcommand with its options and help. The subcommand runs in its CLI11 parse callback.
void add_record(CLI::App& app);
void add_export(CLI::App& app);
void add_plot(CLI::App& app);
void add_compare(CLI::App& app);
void add_report(CLI::App& app);
void add_knot(CLI::App& app);
void add_send(CLI::App& app);

}  // namespace ligature::host
