#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "analysis/space_analysis/space_analysis.h"
#include "renderer/geometry/scene_data.h"
#include "renderer/path/path_observer.h"

namespace lacuna {

/// Triangles of one colour in scene coordinates.
struct OverlayMesh {
  std::string name;
  Rgb colour{1, 1, 1};
  std::vector<V3f> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// The analysis as triangles, for any viewer and for Lacuna itself. Edges are square bars, nodes
/// balls, gates disks; thickness in voxels.
std::vector<OverlayMesh> skeleton_overlay(const SkeletonGraph& graph, const GridTransform& grid);
/// The simplified skeleton, a colour for each visibility cluster, as edges and balls.
std::vector<OverlayMesh> cluster_overlay(const SimplifiedSkeleton& skeleton,
                                         const VisibilityClusters& clusters,
                                         const GridTransform& grid);
std::vector<OverlayMesh> gate_overlay(const VisibilityGates& gates, const GridTransform& grid);
/// The faces of every portal, a colour for each.
std::vector<OverlayMesh> portal_overlay(const Portals& portals, const RegionLabels& regions,
                                        const GridTransform& grid);

/// Each path as bars between its vertices, in a colour of its own; an emitter at infinity as a bar
/// of the length of `box`.
std::vector<OverlayMesh> path_overlay(std::span<const TracedPath> paths, const Bounds& box);

/// A GLB in the coordinates of the scene's file, with these meshes and the scene's triangles and
/// cameras; the scene is grey and transparent (alphaMode BLEND). Throws std::system_error.
void write_overlay(const std::filesystem::path& file, const SceneData& scene,
                   const std::vector<OverlayMesh>& overlay);

}  // namespace lacuna
