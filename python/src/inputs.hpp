#pragma once
#include <string>

#include "protocol/scene/scene.hpp"

namespace ligature::python {

struct Scene {
  scene::Scene scene;
  std::string path;  ///< name in messages
};

}  // namespace ligature::python
