#pragma once

#include <atomic>
#include <span>
#include <vector>

#include "renderer/many_lights/lanes.h"
#include "renderer/many_lights/vpl_contributions.h"

namespace lacuna {

/// Neighbouring shading points with similar depth and normal in one visibility cluster, by their
/// bounding sphere (Noel 2015, 7.3.1 and 7.3.2).
struct GeometryCluster {
  /// A gate, and the lights of a block whose cones through it meet the sphere.
  struct Listed {
    std::uint32_t gate;
    std::uint64_t lights;
  };
  V3f centre;
  float radius;
  std::size_t block = ~std::size_t{0};  ///< of `list`
  std::vector<Listed> list = {};
};

/// Work of clustered shading, in tests of one light's cone through one gate.
struct GateTestCounts {
  std::atomic<std::uint64_t> clusters = 0;  ///< geometry clusters
  std::atomic<std::uint64_t> spheres = 0;   ///< tests of clusters
  std::atomic<std::uint64_t> points = 0;    ///< tests of shading points
  std::atomic<std::uint64_t> all = 0;  ///< tests that shading points would take without clusters
};

/// The geometry clusters of the shading points that are gathered together, a tile of pixels.
class GeometryClusters {
 public:
  /// `cluster`: the visibility cluster of each point; `of_point` takes the geometry cluster.
  GeometryClusters(std::span<const ShadingPoint> points, std::span<const std::uint32_t> cluster,
                   const Camera& camera, GateTestCounts& counts,
                   std::vector<std::uint32_t>& of_point);
  GeometryClusters(const GeometryClusters&) = delete;
  GeometryClusters& operator=(const GeometryClusters&) = delete;
  ~GeometryClusters();

  std::vector<GeometryCluster> clusters;
  std::uint64_t sphere_tests = 0, point_tests = 0, all_tests = 0;  ///< see GateTestCounts

 private:
  GateTestCounts& counts_;
};

/// For eight lights a bit each: whether the cone around the sphere of a gate, `to_gate` from the
/// light, meets a sphere, `to_centre` from the light. Set wherever a point of that sphere lies in
/// the cone of the gate's disk.
unsigned cone_meets(const Float8x3& to_gate, float gate_radius2, const Float8x3& to_centre,
                    float radius);

}  // namespace lacuna
