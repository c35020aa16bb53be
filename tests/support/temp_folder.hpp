#pragma once
// A temporary folder per process: tests run in parallel, and with shared file names they would read each other's files.

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace ligature::test {

/// Path of the folder, ending in '/'. Created at the first call, removed at exit.
inline const std::string& temp_folder() {
  struct Folder {
    std::string path = (std::filesystem::temp_directory_path() / "ligature-test-XXXXXX").string();
    Folder() {
      if (mkdtemp(path.data()) == nullptr) throw std::runtime_error("no folder can be made in " + path);
      path += '/';
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() {
      std::error_code ignored;
      std::filesystem::remove_all(path, ignored);
    }
  };
  static const Folder folder;
  return folder.path;
}

}  // namespace ligature::test
