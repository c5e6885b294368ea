#pragma once

#include <optional>
#include <string>

#include "jobs/import/pbrt/pbrt_context.h"

namespace lacuna::pbrt {

/// A statement with a type: `Film "rgb" ...`.
struct Statement {
  std::string type;
  Parameters parameters;
};

/// What stands before WorldBegin.
struct RenderOptions {
  std::optional<Statement> camera, film, integrator;
  M44d world_from_camera;
  bool tent_filter = false;
};

/// What the options make of the scene.
struct View {
  ImportedCamera camera;
  ImportedPicture picture;
  float exposure = 1;     ///< factor of all light
  bool mirrored = false;  ///< pbrt's world is to be mirrored (x -> -x)
};

/// pbrt's camera space is left-handed (x right, y up, z ahead), so its world is mirrored unless the
/// transform from the camera mirrors already. The camera is that of the mirrored world.
View read_view(Context& context, const RenderOptions& options);

}  // namespace lacuna::pbrt
