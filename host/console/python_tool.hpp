#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace ligature::console {

/// A temporary folder, deleted with its contents by the destructor.
class ScratchFolder {
 public:
  /// Creates the folder. @throws RunFailed when that is not possible.
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] std::string file(const char* name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// Path of the Python of scripts/setup, or of LIGATURE_PYTHON. @throws BadInput when there is none.
[[nodiscard]] std::string find_python();

/// One of this project's Python scripts: beside the installed program, else in the source folder it was built from.
class PythonTool {
 public:
  /// @throws BadInput as find_python(); RunFailed when the script is missing.
  PythonTool(const std::string& script, const std::filesystem::path& source_folder);

  /// Runs the script without a shell and waits; its stderr goes to the file `complaints`. @throws with the last line of
  /// that file: BadInput when the script ends with exit code 2, RunFailed when it fails otherwise.
  void run(const std::vector<std::string>& arguments, const std::string& complaints) const;

 private:
  std::string python_, script_;
};

}  // namespace ligature::console
