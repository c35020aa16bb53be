#include "host/lab/study_command.hpp"

#include <stdlib.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <vector>

#include "host/console/python_tool.hpp"
#include "host/errors.hpp"
#include "host/lab/outcome.hpp"

namespace ligature::lab {
namespace {

// Ends with one line when the package is not installed, or lacks a library.
constexpr const char* kProgram = R"(
import sys
try:
    from ligature.study.__main__ import main
except ImportError as why:
    if isinstance(why, ModuleNotFoundError) and why.name in ('ligature', 'ligature.study'):
        why = 'the Python package is not installed for ' + sys.executable + "; remedy: pip install '.[study]'"
    print('ligature-lab: study:', why, file=sys.stderr)
    sys.exit(2)
if __name__ == '__main__':
    sys.exit(main())
)";

std::string python_or_refuse() {
  try {
    return console::find_python();
  } catch (const host::BadInput& why) {
    throw Refusal(std::string("study: ") + why.what());
  }
}

/// Replaces this process by Python. Returns only by Refusal.
void become_study(const std::vector<std::string>& given) {
  std::vector<std::string> words{python_or_refuse(), "-c", kProgram};
  words.insert(words.end(), given.begin(), given.end());
  std::error_code none;
  // The tasks tie and rerun start this program again.
  setenv("LIGATURE_LAB", std::filesystem::read_symlink("/proc/self/exe", none).c_str(), 1);
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv(arguments[0], arguments.data());
  throw Refusal("study: cannot start " + words[0] + ": " + std::strerror(errno), kRunFailed);
}

}  // namespace

void add_study_command(CLI::App& app) {
  auto* study = app.add_subcommand("study", "Many runs over parameters and seeds, on all cores or on a cluster");
  study->set_help_flag();  // Python prints the help
  study->prefix_command();
  study->callback([study] { become_study(study->remaining()); });
}

}  // namespace ligature::lab
