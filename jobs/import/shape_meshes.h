#pragma once

#include <numbers>
#include <string>
#include <vector>

#include "jobs/import/imported_scene.h"

namespace lacuna {

// Shapes of other renderers as triangles, in their own coordinates: exact normals and texture
// coordinates at the vertices; front outside (of flat ones: where z grows).

/// A corner of a profile that turns about the z axis: radius and height, its normal's radial and
/// axial part, and its v.
struct ProfilePoint {
  double radius = 0, z = 0;
  double normal_radial = 0, normal_z = 0;
  double v = 0;
};

/// Full turns have so many segments. The inscribed polygon is enlarged so that its area is that of
/// the circle; no point is then further from it than 3e-4 of the radius.
inline constexpr int turn_segments = 128;

/// A surface of revolution: the azimuth runs from 0 (+x) over +y to `phi_max` (radians, at most 2
/// pi), u = azimuth / phi_max; v is that of the profile, whose points run from bottom to top as
/// seen with the front on the right. Segments of the profile at radius 0 give single triangles.
ImportedMesh revolution_mesh(const std::string& name, const std::vector<ProfilePoint>& profile,
                             double phi_max = 2 * std::numbers::pi);

/// A sphere of radius 1 from z_min to z_max; v = 0 at z_min and 1 at z_max, linear in the polar
/// angle. A whole one has the area 4 pi, hence on average over directions a silhouette of area pi;
/// in each direction within 1e-4.
ImportedMesh sphere_mesh(double z_min = -1, double z_max = 1,
                         double phi_max = 2 * std::numbers::pi);
/// The lateral surface of a cylinder of radius 1 from z = 0 (v = 0) to 1 (v = 1).
ImportedMesh cylinder_mesh(double phi_max = 2 * std::numbers::pi);
/// A disk of radius 1 at z = 0, without its part below `inner_radius`; v = 0 at the rim, 1 at the
/// centre or the inner rim.
ImportedMesh disk_mesh(double inner_radius = 0, double phi_max = 2 * std::numbers::pi);
/// The square from -1 to 1 in x and y; u and v from 0 to 1 along them.
ImportedMesh rectangle_mesh();
/// The cube from -1 to 1; each face has the whole square of u and v, as Mitsuba's (row 0 of a
/// picture at v = 0: its v points down).
ImportedMesh cube_mesh();

}  // namespace lacuna
