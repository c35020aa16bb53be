#include "host/lab/pareto/setting.hpp"

#include <algorithm>
#include <sstream>

#include "host/lab/outcome.hpp"
#include "host/lab/pareto/specimens.hpp"
#include "protocol/scene/scene_file.hpp"

namespace ligature::lab {
namespace {

using scene::Model;

constexpr Model kPaper[] = {Model::kPaper1, Model::kPaper2, Model::kPaper3, Model::kPaper4, Model::kPaper5};
constexpr const char* kPresets[] = {"fast", "balanced", "fine"};

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
  const Refusal refused("--one: found " + text + ", allowed MODEL/NODES/SUBSTEPS/PASSES or rod/NODES/PRESET");
  Setting s;
  bool known = false;
  for (const Model m : {kPaper[0], kPaper[1], kPaper[2], kPaper[3], kPaper[4], Model::kRod}) {
    if (!words.empty() && words[0] == scene::name(m)) s.model = m, known = true;
  }
  try {
    if (known && words.size() == 3 &&
        std::find(std::begin(kPresets), std::end(kPresets), words[2]) != std::end(kPresets)) {
      s.nodes = std::stoi(words[1]);
      s.preset = words[2];
      return s;
    }
    if (known && words.size() == 4) {
      s.nodes = std::stoi(words[1]);
      s.substeps = std::stoi(words[2]);
      s.passes = std::stoi(words[3]);
      return s;
    }
  } catch (const std::logic_error&) {  // no number where one should be
    throw refused;
  }
  throw refused;
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
