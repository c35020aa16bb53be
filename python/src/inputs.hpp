#pragma once
#include <string>

#include "protocol/scene/scene.hpp"

namespace ligature::python {

struct Scene {
  scene::Scene scene;
  std::string path;  ///< how messages call it
};

}  // namespace ligature::python
