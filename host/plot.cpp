#include "host/plot.hpp"

#include <filesystem>
#include <vector>

#include "host/atomic_file.hpp"
#include "host/console/python_tool.hpp"
#include "host/damage_notice.hpp"
#include "host/errors.hpp"
#include "host/export.hpp"
#include "host/knot/common_name.hpp"
#include "host/knot/recognise.hpp"
#include "host/polyline_file.hpp"
#include "host/regular_file.hpp"
#include "host/rig_facts.hpp"
#include "host/text.hpp"

namespace ligature::host {
namespace {

namespace fs = std::filesystem;

/// Checks the ending. @return path of the picture, symbolic links followed.
std::string checked_target(const std::string& out_path) {
  const auto ending = fs::path(out_path).extension();
  if (ending != ".png" && ending != ".svg" && ending != ".pdf")
    throw BadInput(out_path + ": found ending '" + ending.string() + "', allowed .png, .svg or .pdf");
  return AtomicFile(out_path).path();  // creates and removes the file: tests early that it can be created
}

/// Exports one recording's forces to a CSV file.
ExportResult export_forces(const std::string& log_path, const std::string& forces_csv) {
  auto exported = export_recording(log_path, {.csv = {.forces = forces_csv, .shape = {}, .ticks = {}}});
  tell_damage(log_path, exported.damage);
  return exported;
}

/// Exports one recording's forces to a CSV file. @return the script's arguments for it.
std::vector<std::string> table_of(const std::string& log_path, const std::string& forces_csv) {
  const RigFacts facts = read_rig_facts(log_path);
  export_forces(log_path, forces_csv);
  const std::string log = fs::path(log_path).filename().string();
  const std::string scene = fs::path(facts.scene_file).filename().string();
  return {forces_csv, "--title", scene.empty() ? log : scene, "--limit", text("%.17g", facts.max_force_N)};
}

}  // namespace

void plot(const std::string& log_path, const std::string& out_path, bool by_frame) {
  const std::string target = checked_target(out_path);
  const console::PythonTool tool("plot_forces.py", LIGATURE_PLOTS_DIR);
  const console::ScratchFolder scratch;
  auto words = table_of(log_path, scratch.file("forces.csv"));
  words.insert(words.end(), {"--out", target});
  if (by_frame) words.emplace_back("--frames");
  tool.run(words, scratch.file("complaints"));
}

void plot_thread(const std::string& log_path, const std::string& out_path) {
  const std::string target = checked_target(out_path);
  const Polyline line = read_polyline_log(log_path, std::nullopt);
  tell_damage(log_path, line.damage);
  const auto found = knot::recognise(line.points, false);
  const console::PythonTool tool("plot_thread.py", LIGATURE_PLOTS_DIR);
  const console::ScratchFolder scratch;
  AtomicFile shape(scratch.file("shape.csv"));
  for (const auto& p : line.points) shape.write(text("%.9g,%.9g,%.9g\n", p[0], p[1], p[2]));
  shape.commit();
  const std::string title =
      fs::path(log_path).filename().string() + ": " + knot::full_name(found.type, found.handedness);
  tool.run({scratch.file("shape.csv"), "--radius", text("%.17g", line.radius_m), "--title", title, "--out", target},
           scratch.file("complaints"));
}

void plot_latency(const std::vector<std::string>& reports, const std::string& out_path) {
  const std::string target = checked_target(out_path);
  // refuses a pipe, whose writer the script would wait for
  for (const auto& report : reports) static_cast<void>(RegularFile(report));
  const console::PythonTool tool("plot_latency.py", LIGATURE_PLOTS_DIR);
  const console::ScratchFolder scratch;
  auto words = reports;
  words.insert(words.end(), {"--out", target});
  tool.run(words, scratch.file("complaints"));
}

void plot_comparison(const std::string& log_a, const std::string& log_b, const std::string& out_path,
                     const std::string& align, double shift_s) {
  const std::string target = checked_target(out_path);
  const console::PythonTool tool("plot_comparison.py", LIGATURE_PLOTS_DIR);
  const console::ScratchFolder scratch;
  std::vector<std::string> words;
  for (const auto& [log, name] : {std::pair{log_a, "a.csv"}, std::pair{log_b, "b.csv"}}) {
    const auto exported = export_forces(log, scratch.file(name));
    if (align == "grasp" && !exported.has_grasp)
      throw BadInput(log + ": --align grasp: the log has no grasp; align by start");
    words.push_back(scratch.file(name));
    words.push_back(fs::path(log).filename().string());
  }
  words.insert(words.end(), {"--out", target, "--align", align, "--shift", text("%.17g", shift_s)});
  tool.run(words, scratch.file("complaints"));
}

}  // namespace ligature::host
