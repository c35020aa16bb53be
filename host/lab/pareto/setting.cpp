#include "host/lab/pareto/setting.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <sstream>
#include <system_error>

#include "host/lab/outcome.hpp"
#include "host/lab/pareto/specimens.hpp"
#include "protocol/scene/scene_file.hpp"

namespace ligature::lab {
namespace {

using scene::Model;

constexpr Model kPaper[] = {Model::kPaper1, Model::kPaper2, Model::kPaper3, Model::kPaper4, Model::kPaper5};
constexpr const char* kPresets[] = {"fast", "balanced", "fine"};

/// A number of --one, and what it may be: nodes and substeps as in a scene, where the rod needs 4 nodes.
struct Number {
  const char* name;
  int least, most;
  int Setting::*value;
};
constexpr Number kNumbers[] = {{"NODES", 4, 5000, &Setting::nodes},
                               {"SUBSTEPS", 1, 10'000, &Setting::substeps},
                               {"PASSES", 0, 1000, &Setting::passes}};
constexpr int kMostWork = 2'000'000;  // nodes times substeps

}  // namespace

std::string Setting::text() const {
  std::ostringstream out;
  out << scene::name(model) << '/' << nodes << '/';
  if (preset.empty()) {
    out << substeps << '/' << passes;
  } else {
    out << preset;
  }
  return out.str();
}

Setting setting_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; std::getline(in, word, '/');) words.push_back(word);
  const auto refuse = [&text](const std::string& allowed) {
    throw Refusal("--one: found " + text + ", allowed " + allowed);
  };
  constexpr const char* kForms = "MODEL/NODES/SUBSTEPS/PASSES or rod/NODES/PRESET";
  Setting s;
  bool known = false;
  for (const Model m : {kPaper[0], kPaper[1], kPaper[2], kPaper[3], kPaper[4], Model::kRod}) {
    if (!words.empty() && words[0] == scene::name(m)) s.model = m, known = true;
  }
  const bool has_preset = words.size() == 3 && s.model == Model::kRod &&
                          std::find(std::begin(kPresets), std::end(kPresets), words[2]) != std::end(kPresets);
  if (!known || (words.size() != 4 && !has_preset)) refuse(kForms);
  if (has_preset) s.preset = words[2];
  for (std::size_t k = 0; k < (has_preset ? 1U : std::size(kNumbers)); ++k) {
    const auto& [name, least, most, value] = kNumbers[k];
    const std::string& word = words[k + 1];
    const auto [at, error] = std::from_chars(word.data(), word.data() + word.size(), s.*value);
    if (error != std::errc{} || at != word.data() + word.size() || s.*value < least || s.*value > most)
      refuse(std::string(name) + " " + std::to_string(least) + " .. " + std::to_string(most));
  }
  if (!has_preset && s.substeps > kMostWork / s.nodes)
    refuse("NODES times SUBSTEPS up to " + std::to_string(kMostWork));
  if (s.text() != text) refuse(kForms);  // with a slash at its end, for example
  return s;
}

Setting finest(Model model) {
  if (model == Model::kRod) return {model, 300, 60, 40, {}};
  Setting s{model, 200, 1, 0, {}};
  s.substeps = 2 * stable_substeps(model, s.nodes);
  return s;
}

std::vector<Setting> all_settings(bool quick) {
  std::vector<Setting> all;
  const std::vector<int> nodes =
      quick ? std::vector<int>{50, 154} : std::vector<int>{20, 35, 50, 100, 154, 200, 350, 500};
  for (const int n : nodes) {
    for (const Model m : kPaper) {
      const int least = stable_substeps(m, n);
      for (const int times : quick || n > 200 ? std::vector<int>{1} : std::vector<int>{1, 2}) {
        all.push_back({m, n, least * times, 0, {}});
      }
    }
    for (const int substeps : quick || n > 200 ? std::vector<int>{10, 24} : std::vector<int>{6, 10, 16, 24, 40}) {
      const bool vary = !quick && substeps == 16 && n <= 200;
      for (const int passes : vary ? std::vector<int>{4, 12, 40} : std::vector<int>{12}) {
        all.push_back({Model::kRod, n, substeps, passes, {}});
      }
    }
    for (const char* preset : kPresets) {
      if (n >= 50) all.push_back({Model::kRod, n, 0, 0, preset});
    }
  }
  return all;
}

}  // namespace ligature::lab
