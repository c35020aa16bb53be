#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace ligature::console {

/// A folder that is gone when this is.
class ScratchFolder {
 public:
  /// @throws RunFailed.
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] std::string file(const char* name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// A Python script of ours, beside an installed program or in the folder of the source tree that it was built from.
class PythonTool {
 public:
  /// @throws BadInput without the Python of scripts/setup or LIGATURE_PYTHON; RunFailed without the script.
  PythonTool(const std::string& script, const std::filesystem::path& source_folder);

  /// Runs it without a shell, its stderr into the file `complaints`, and waits. @throws RunFailed with its last word.
  void run(const std::vector<std::string>& arguments, const std::string& complaints) const;

 private:
  std::string python_, script_;
};

}  // namespace ligature::console
