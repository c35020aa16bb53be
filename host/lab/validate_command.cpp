#include "host/lab/validate_command.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "host/console/progress.hpp"
#include "host/console/stop_signal.hpp"
#include "host/lab/option_checks.hpp"
#include "host/lab/outcome.hpp"
#include "host/lab/report.hpp"
#include "host/lab/run_files.hpp"
#include "host/lab/validate/cases.hpp"
#include "host/lab/validate/convergence.hpp"
#include "host/lab/validate/proceed.hpp"
#include "protocol/scene/scene_file.hpp"

namespace ligature::lab {
namespace {

namespace v = ligature::validate;
using Json = nlohmann::ordered_json;

constexpr const char* kFooter = R"(
Each case is an experiment with a known answer (closed form, or computed elsewhere: tests/reference, built into the
program). The table gives the worst figure of a case; --out keeps every one. A model that lacks a case's physics is not
judged on it. The cases and what they compare with:
)";

constexpr const char* kExamples = R"(
Exit: 0 every judged case within its tolerance; 1 a case fails; 2 usage; 130 interrupted: the cases before it are
printed and written.

Examples
  ligature-lab validate                                    the rod at 50 and at 200 nodes
  ligature-lab validate --model paper-4 --nodes 50
  ligature-lab validate --only capstan --nodes 200 --out out/validate
  ligature-lab validate --convergence                      order in N and in substeps)";

struct Arguments {
  std::string model = "rod";
  std::string accuracy;
  std::optional<int> nodes;
  std::string only;
  std::string out;
  double share = 1.0;
  bool quick = false;
  bool convergence = false;
};

std::vector<std::pair<std::string, scene::Model>> models() {
  std::vector<std::pair<std::string, scene::Model>> all;
  for (const auto m : {scene::Model::kPaper1, scene::Model::kPaper2, scene::Model::kPaper3, scene::Model::kPaper4,
                       scene::Model::kPaper5, scene::Model::kRod}) {
    all.emplace_back(scene::name(m), m);
  }
  return all;
}

scene::Model model_of(const std::string& name) {
  for (const auto& [known, model] : models()) {
    if (known == name) return model;
  }
  throw Refusal("--model: found " + name + ", allowed paper-1 .. paper-5, rod");
}

std::optional<scene::Accuracy> accuracy_of(const std::string& name) {
  if (name.empty()) return std::nullopt;
  if (name == "fast") return scene::Accuracy::kFast;
  if (name == "balanced") return scene::Accuracy::kBalanced;
  if (name == "fine") return scene::Accuracy::kFine;
  throw Refusal("--accuracy: found " + name + ", allowed fast, balanced, fine");
}

std::vector<int> nodes_of(const Arguments& a) {
  if (!a.nodes) return {50, 200};
  if (*a.nodes != 50 && *a.nodes != 200) {
    throw Refusal("--nodes: found " + std::to_string(*a.nodes) + ", allowed 50, 200 (tolerances exist for these)");
  }
  return {*a.nodes};
}

/// Result of a case: not modelled, or its findings.
struct Outcome {
  const v::Case* examined;
  int nodes = 0;
  bool modelled = true;
  v::Findings findings;

  [[nodiscard]] bool holds() const {
    return std::all_of(findings.begin(), findings.end(), [](const v::Finding& f) { return f.holds(); }) &&
           !(modelled && findings.empty());
  }
  /// The finding with the largest error relative to its tolerance; NaN counts as worst.
  [[nodiscard]] const v::Finding* worst() const {
    const auto badness = [](const v::Finding& f) {
      if (!(f.error == f.error)) return 1e300;
      return f.error > f.tolerance ? 1.0 + f.error / std::max(f.tolerance, 1e-3)
                                   : f.error / std::max(f.tolerance, 1e-12);
    };
    const v::Finding* worst = nullptr;
    for (const auto& f : findings) {
      if (!worst || badness(f) > badness(*worst)) worst = &f;
    }
    return worst;
  }
};

std::string percent_or_plain(double value, const std::string& unit) {
  if (unit == "relative") return digits(100.0 * value) + " %";
  if (unit == "of L") return digits(100.0 * value) + " % of L";
  return digits(value) + (unit == "outside" ? "" : " " + unit);
}

void add_row(Table& table, const Outcome& o) {
  const std::string n = std::to_string(o.nodes);
  if (!o.modelled) {
    table.row({std::string(o.examined->name), n, std::string("not modelled"), std::string("-"), std::string("-"),
               std::string("-"), std::string("-"), std::string("-")});
    return;
  }
  const auto* f = o.worst();
  if (!f) {
    table.row({std::string(o.examined->name), n, std::string("gave no figure"), std::string("-"), std::string("-"),
               std::string("-"), std::string("-"), std::string("FAIL")});
    return;
  }
  table.row({std::string(o.examined->name), n, f->what, digits(f->reference, 5), digits(f->measured, 5),
             percent_or_plain(f->error, f->unit), percent_or_plain(f->tolerance, f->unit),
             std::string(o.holds() ? "PASS" : "FAIL")});
}

void write_files(const std::string& folder, const std::string& model, const std::vector<Outcome>& outcomes) {
  Table csv({"model", "case", "nodes", "what", "reference", "measured", "error", "tolerance", "unit", "verdict"});
  Json json = Json::array();
  for (const auto& o : outcomes) {
    if (!o.modelled) {
      csv.row({model, std::string(o.examined->name), double(o.nodes), std::string("not modelled"), std::string(),
               std::string(), std::string(), std::string(), std::string(), std::string()});
      json.push_back({{"model", model}, {"case", o.examined->name}, {"nodes", o.nodes}, {"verdict", "not modelled"}});
    }
    for (const auto& f : o.findings) {
      const std::string verdict = f.holds() ? "PASS" : "FAIL";
      csv.row({model, std::string(o.examined->name), double(o.nodes), f.what, f.reference, f.measured, f.error,
               f.tolerance, f.unit, verdict});
      json.push_back({{"model", model},
                      {"case", o.examined->name},
                      {"nodes", o.nodes},
                      {"what", f.what},
                      {"reference", f.reference},
                      {"measured", f.measured},
                      {"error", f.error},
                      {"tolerance", f.tolerance},
                      {"unit", f.unit},
                      {"verdict", verdict}});
    }
  }
  const std::filesystem::path out(folder);
  csv.write(out / "validate.csv");
  write_text(out / "validate.json", json.dump(1) + "\n");
}

int show_convergence(const std::string& out) {
  Table table({"quantity", "resolution", "error", "order"});
  {
    console::Progress progress("validate");
    progress.show(0.0, "six ladders");
    for (const auto& ladder : v::convergence()) {
      for (std::size_t k = 0; k < ladder.error.size(); ++k) {
        table.row(
            {k == 0 ? ladder.what : std::string(), ladder.resolution[k], ladder.error[k],
             k == 0 ? Cell(ladder.order() > 0.5 ? digits(ladder.order()) : std::string("none")) : Cell(std::string())});
      }
    }
  }
  table.print();
  if (!out.empty()) table.write(std::filesystem::path(out) / "convergence.csv");
  return kDone;
}

/// Examines the chosen cases. @return the case that was interrupted, or an empty text. `outcomes` has those before it.
std::string examine_all(const Arguments& a, scene::Model model, std::optional<scene::Accuracy> accuracy,
                        const std::vector<int>& nodes, std::vector<Outcome>& outcomes) {
  console::Progress progress("validate");
  const auto cases = v::all_cases();
  double done = 0.0;
  const double whole = static_cast<double>(cases.size() * nodes.size());
  for (const auto& c : cases) {
    for (const int n : nodes) {
      progress.show(done++ / whole, std::string(c.name) + ", N = " + std::to_string(n));
      if (!a.only.empty() && a.only != c.name) continue;
      if (a.quick && !c.quick) continue;
      if (c.only_nodes > 0 && n != nodes.front()) continue;
      Outcome o{&c, c.only_nodes > 0 ? c.only_nodes : n, c.is_modelled(model), {}};
      try {
        if (o.modelled) o.findings = c.examine({model, o.nodes, accuracy});
      } catch (const v::Interrupted&) {
        return std::string(c.name);
      }
      for (auto& f : o.findings) f.tolerance *= a.share;
      outcomes.push_back(std::move(o));
    }
  }
  return {};
}

/// Prints the table. @return how many cases fail
int print_table(const std::string& model, const std::vector<Outcome>& outcomes) {
  Table table({"case", "N", "worst figure", "reference", "measured", "error", "tolerance", "verdict"});
  int failed = 0, judged = 0;
  for (const auto& o : outcomes) {
    judged += o.modelled;
    failed += o.modelled && !o.holds();
    add_row(table, o);
  }
  std::printf("model %s\n", model.c_str());
  table.print();
  std::printf("%d judged, %d failed, %zu not modelled\n", judged, failed,
              outcomes.size() - static_cast<std::size_t>(judged));
  return failed;
}

int execute(const Arguments& a) {
  const auto model = model_of(a.model);
  const auto accuracy = accuracy_of(a.accuracy);
  const auto nodes = nodes_of(a);
  if (!a.only.empty() && !v::find_case(a.only))
    throw Refusal("--only: found " + a.only + ", allowed a case that validate --help lists");
  if (!(a.share > 0.0 && a.share <= 1.0))
    throw Refusal("--share: found " + digits(a.share) + ", allowed above 0, 1 at most");
  if (!a.out.empty()) make_folder(a.out);
  v::stop_asked = console::stop_requested;
  if (a.convergence) return show_convergence(a.out);
  std::vector<Outcome> outcomes;
  const std::string interrupted = examine_all(a, model, accuracy, nodes, outcomes);
  if (!interrupted.empty() && outcomes.empty())
    throw Refusal("validate: interrupted in " + interrupted + ", nothing measured", kInterrupted);
  const int failed = print_table(a.model, outcomes);
  if (!a.out.empty()) {
    write_files(a.out, a.model, outcomes);
    std::printf("files %s/{validate.csv,validate.json}\n", a.out.c_str());
  }
  if (!interrupted.empty()) {
    std::fprintf(stderr, "validate: interrupted in %s; what was measured before is above\n", interrupted.c_str());
    return kInterrupted;
  }
  return failed == 0 ? kDone : kMissed;
}

}  // namespace

void add_validate_command(CLI::App& app, int& exit_code) {
  auto a = std::make_shared<Arguments>();
  auto* command = app.add_subcommand("validate", "A model against experiments with a known answer");
  command->add_option("--model", a->model, "paper-1 .. paper-5 or rod")->capture_default_str();
  command
      ->add_option("--accuracy", a->accuracy,
                   "The rod's: fast, balanced or fine [balanced; fine for 200 nodes on a desk]")
      ->check(not_empty);
  command->add_option("--nodes", a->nodes, "50 or 200 [both]")->type_name("N");
  command->add_option("--only", a->only, "One case, by name")->type_name("CASE")->check(not_empty);
  command
      ->add_option("--share", a->share, "Share of each tolerance that a case may use: what passes at 0.5 has a margin")
      ->capture_default_str();
  command->add_option("--out", a->out, "Folder for validate.csv and validate.json")->type_name("DIR")->check(not_empty);
  command->add_flag("--quick", a->quick, "Only the cases that take a moment");
  command->add_flag("--convergence", a->convergence, "Order in N and in substeps instead (rod)");
  std::string footer = kFooter;
  for (const auto& c : v::all_cases()) {
    std::string name = c.name;
    name.resize(22, ' ');
    footer += "  " + name + c.about + "\n";
  }
  command->footer(footer + kExamples);
  command->callback([a, &exit_code] { exit_code = execute(*a); });
}

}  // namespace ligature::lab
