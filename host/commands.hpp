#pragma once

namespace CLI {
class App;
}

namespace ligature::host {

/// Adds the subcommands with their options and help; each does its work as the callback of its parsing.
void add_record(CLI::App& app);
void add_export(CLI::App& app);
void add_plot(CLI::App& app);
void add_compare(CLI::App& app);
void add_report(CLI::App& app);
void add_knot(CLI::App& app);
void add_send(CLI::App& app);

}  // namespace ligature::host
