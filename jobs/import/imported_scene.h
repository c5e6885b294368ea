#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "jobs/import/daylight.h"
#include "jobs/import/imported_material.h"
#include "renderer/core/vec.h"
#include "renderer/settings/camera_settings.h"

namespace lacuna {

// What is read of a scene file of another renderer, before it is written as glTF and a job. Right-
// handed coordinates; matrices in Imath's convention (row vectors, p_world = p * to_world).
// `place` names the element of the source (file, line, name) in messages.

/// Triangles in their own coordinates. Several shapes may share one.
struct ImportedMesh {
  std::string name;
  std::vector<V3f> positions;
  std::vector<V3f> normals;  ///< empty (flat), or one per position; need not be unit
  std::vector<V2f> uvs;      ///< v upwards, as OBJ has it; empty, or one per position
  std::vector<Rgb>
      colors;  ///< linear, multiply the diffuse reflectance; empty, or one per position
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise from the front
};

/// A mesh with its place and material.
struct ImportedShape {
  std::string name, place;
  std::shared_ptr<const ImportedMesh> mesh;
  M44d to_world;
  bool flipped = false;  ///< the front is where the triangles are clockwise
  std::shared_ptr<const ImportedMaterial> material;
  std::optional<ImportedValue> radiance;  ///< of an area light; emitted in front
  bool emits_behind = false;              ///< of an area light: behind as well
};

/// A point, spot or directional light.
struct ImportedLight {
  enum class Kind { point, spot, directional };
  Kind kind = Kind::point;
  std::string name;
  Rgb intensity{1, 1, 1};  ///< W/sr; directional: W/m^2
  V3d position{0, 0, 0};
  V3d direction{0, 0, -1};          ///< of the light's travel
  double inner_cone = 0;            ///< radians, half angle of full intensity
  double outer_cone = 0.785398163;  ///< radians, half angle of none
};

/// Light from infinitely far: radiance `scale` times that of an equirectangular picture.
struct ImportedEnvironment {
  /// How a picture holds directions. `equal_area` is pbrt-v4's: equal_area_square() of the
  /// direction in the picture's own coordinates with x reversed.
  enum class Layout { equirectangular, equal_area };
  std::filesystem::path file;  ///< empty: constant
  Layout layout = Layout::equirectangular;
  Rgb scale{1, 1, 1};
  /// In place of a file: a sky or sun, whose own coordinates `to_world` turns; not `scale`.
  std::optional<Daylight> daylight;
  int daylight_width = 512;  ///< texels
  /// Directions of the picture to those of the world. In the picture's own coordinates the centre
  /// is +x, up is +z, and the azimuth grows to the left (towards +y).
  M44d to_world;
  std::string place;
};

/// A camera that looks along -z of `to_world`, x right, y up; `to_world` has no scale.
struct ImportedCamera {
  std::string name, place;
  Projection projection = Projection::perspective;
  M44d to_world;
  double yfov = 0.8;    ///< perspective: vertical field of view of the whole picture, radians
  double height = 2;    ///< orthographic: of the picture, scene units
  double aperture = 0;  ///< radius of the lens, scene units; 0: a pinhole
  double focus = 1;     ///< distance of the sharp plane, scene units
  int blades = 0;       ///< as CameraSettings::blades
};

/// The picture that the file asks for.
struct ImportedPicture {
  std::array<int, 2> resolution{1280, 720};
  std::optional<std::array<int, 2>> crop_from;  ///< of `resolution`, in pixels from the upper left
  std::array<int, 2> crop_size{0, 0};
  std::optional<int> max_depth;  ///< path edges; none: the file sets no limit
  bool tent_filter = false;      ///< of pixels, to the centres of their neighbours; else a box
};

/// A part of the file that the result does not represent exactly.
struct ImportNote {
  std::string place;      ///< file and line
  std::string name;       ///< of the part, e.g. `bsdf "chrome" (roughconductor)`
  std::string treatment;  ///< "approximated" or "left out"
  std::string how;
};

struct ImportedScene {
  std::vector<ImportedShape> shapes;
  std::vector<ImportedLight> lights;
  std::vector<ImportedCamera> cameras;  ///< the first is that of the job
  std::optional<ImportedEnvironment> environment;
  ImportedPicture picture;
  std::vector<ImportNote> notes;
};

/// What to do about files that a scene names and that do not exist.
enum class MissingFiles { refuse, skip };

}  // namespace lacuna
