#include <cstdio>

#include "host/console/python_tool.hpp"
#include "host/errors.hpp"
#include "host/lab/report.hpp"

namespace ligature::lab {

void draw(const std::string& script, const std::vector<std::filesystem::path>& data,
          const std::filesystem::path& picture) {
  std::vector<std::string> words;
  words.reserve(data.size() + 1);
  for (const auto& file : data) words.push_back(file.string());
  words.push_back(picture.string());
  const auto complain = [&](const std::exception& error) {
    std::printf("no picture %s: %s; the table is there\n", picture.c_str(), error.what());
  };
  try {
    const console::ScratchFolder scratch;
    console::PythonTool(script, LIGATURE_LAB_PLOTS_DIR).run(words, scratch.file("complaints"));
    std::printf("picture %s\n", picture.c_str());
  } catch (const host::BadInput& error) {
    complain(error);
  } catch (const host::RunFailed& error) {
    complain(error);
  }
}

}  // namespace ligature::lab
