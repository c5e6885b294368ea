#pragma once

#include <numbers>

#include "tests/renderer/gltf/glb_builder.h"

namespace lacuna::extremes {

using test::Bytes;

/// What is added to a room without changing its picture.
enum class Clutter { none, zero_area, duplicated_vertices, coincident, needles };

/// Which cells of a panel shine, and what makes the others dark.
enum class Glow { all, half, half_by_texture };

/// A closed room under a panel of light, with a wall that has a doorway, and a shiny block: light,
/// shadow, reflection, and an empty space whose skeleton leads through the door. No face lies on
/// the border of two voxels, so that rounding moves no voxel.
struct Room {
  double scale = 1, offset = 0;  ///< every coordinate is scale x + offset
  double radiance = 1;           ///< multiplies that of the panel and of the points
  int points = 0;                ///< point lights in one place; together they have one power
  int panel_cells = 1;           ///< the panel is so many times so many squares
  int panels = 1;                ///< so many of them in one place
  Glow glow = Glow::all;         ///< of the panels' cells
  int texels = 0;                ///< along a side of the texture of half_by_texture
  Clutter clutter = Clutter::none;
};
Bytes room(const Room& room);

/// A closed box of side 1 (height: `height`) whose walls shine with `radiance` and reflect `albedo`
/// of what meets them. With n >= 0 edges at most, every pixel is radiance times the sum of albedo^k
/// for k < n.
struct Furnace {
  double albedo = 0.5, radiance = 1, height = 1;
  float eye = 0.375F;  ///< the camera's height as a share of the box's
  double offset = 0;   ///< added to every coordinate
  Json content = {};   ///< material of a block in the middle, if it is not null
};
Bytes furnace(const Furnace& furnace);

/// A block of a tenth of a unit on a floor of side 2 `half_side`, under a panel of light; the eye
/// sees the block's shadow.
Bytes block_on_floor(double half_side);

/// A dark room under a spot of `intensity` (W/sr) whose light falls on its back wall, of albedo
/// `albedo`, at a distance of `distance`; the camera sees what is lit fully, head-on.
struct Beam {
  double outer = 0.1, inner = 0.09;  ///< half angles, radians
  double intensity = 10, albedo = 0.5, distance = 1.875;

  /// What every pixel of a narrow beam shows.
  double radiance() const { return albedo / std::numbers::pi * intensity / (distance * distance); }
};
Bytes beam(const Beam& beam);

/// A diffuse material that reflects no light in any other way.
Json diffuse(const std::array<double, 3>& albedo);
/// A metal of albedo 1, or clear glass. Roughness is glTF's: the square root of GGX's alpha.
Json metal(double roughness);
Json glass(double roughness);

}  // namespace lacuna::extremes
