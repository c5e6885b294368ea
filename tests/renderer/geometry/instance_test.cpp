#include "renderer/geometry/instance.h"

#include <gtest/gtest.h>

#include <numbers>

#include "renderer/core/rng.h"
#include "renderer/core/sampling.h"
#include "renderer/scene/scene_shape.h"
#include "tests/renderer/scene/scene_parts.h"

namespace lacuna {
namespace {

using test::SceneParts;

constexpr double turn = 2 * std::numbers::pi;

V3d direction(Rng& rng) {
  const double z = 2 * double(rng.next()) - 1, phi = turn * double(rng.next());
  const double s = std::sqrt(1 - z * z);
  return {s * std::cos(phi), s * std::sin(phi), z};
}

double logarithmic(Rng& rng, double low, double high) {
  return low * std::pow(high / low, double(rng.next()));
}

/// A rotation of either orientation, of another scale along each axis or of one.
M44d random_transform(Rng& rng, const V3d& at, bool mirrored, bool stretched) {
  const V3d x = direction(rng), y = x.cross(direction(rng)).normalized(), z = x.cross(y);
  const V3d axes[3] = {x, y, mirrored ? -z : z};
  M44d m;
  const double scale = logarithmic(rng, 0.3, 3);
  for (int i = 0; i < 3; ++i) {
    const V3d axis = axes[i] * (stretched ? logarithmic(rng, 0.3, 3) : scale);
    for (int k = 0; k < 3; ++k) m[i][k] = axis[k];
  }
  for (int k = 0; k < 3; ++k) m[3][k] = at[k];
  return m;
}

/// A sphere of radius 1 with smooth normals; `mirrored`: as a prototype under a mirroring
/// transform.
Mesh sphere(std::uint32_t material, bool mirrored) {
  constexpr int around = 24, up = 12;
  Mesh mesh;
  mesh.material = material;
  for (int j = 0; j <= up; ++j) {
    for (int i = 0; i < around; ++i) {
      const double theta = turn / 2 * j / up, phi = turn * i / around;
      mesh.positions.emplace_back(std::sin(theta) * std::cos(phi), std::cos(theta),
                                  -std::sin(theta) * std::sin(phi));
    }
  }
  for (std::uint32_t j = 0; j < up; ++j) {
    for (std::uint32_t i = 0; i < around; ++i) {
      const std::uint32_t next = (i + 1) % around, a = j * around + i, b = j * around + next;
      if (j + 1 < up) mesh.triangles.push_back({a, a + around, b + around});
      if (j > 0) mesh.triangles.push_back({a, b + around, b});
    }
  }
  mesh.normals = mesh.positions;
  if (mirrored) {
    for (V3f& n : mesh.normals) n = -n;
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  }
  return mesh;
}

/// Spheres in a box of side 20: a prototype of each orientation, and instances of both.
SceneData instances_of_spheres(int count, bool stretched) {
  SceneParts parts;
  const auto white = parts.material(test::diffuse(Rgb(0.8F)));
  parts.box({-10, -10, -10}, {10, 10, 10}, false, white);
  SceneData& data = parts.data;
  for (const bool mirrored : {false, true}) {
    data.prototypes.push_back({static_cast<std::uint32_t>(data.meshes.size()), 1});
    data.meshes.push_back(sphere(white, mirrored));
  }
  Rng rng(3, 0, 0, Rng::Purpose::test);
  for (int i = 0; i < count; ++i) {
    const bool mirrored = i % 2 == 1;
    data.instances.emplace_back(random_transform(rng, direction(rng) * 7.0, mirrored, stretched),
                                mirrored ? 1U : 0U);
  }
  data.bound_ray_errors();
  return std::move(parts.data);
}

/// The same scene with a mesh for each instance.
SceneData copied(const SceneData& scene) {
  SceneData out;
  out.materials = scene.materials;
  for (const Mesh& mesh : scene.placed_meshes()) out.meshes.push_back(mesh);
  for (const Instance& instance : scene.instances) {
    for (const Mesh& mesh : scene.meshes_of(scene.prototypes[instance.prototype])) {
      Mesh& copy = out.meshes.emplace_back(mesh);
      for (V3f& p : copy.positions) p = instance.point(p);
      for (V3f& n : copy.normals) n = instance.normal(n).normalized();
    }
  }
  return out;
}

struct Difference {
  int rays = 0, others = 0;  ///< that hit another triangle
  float point = 0, ng = 0, ns = 0;
};

/// Compares the surfaces that rays find in two scenes with equal triangles.
Difference compare(const Scene& a, const Scene& b) {
  Rng rng(4, 0, 0, Rng::Purpose::test);
  Difference d;
  for (int i = 0; i < 20000; ++i) {
    const Ray ray{V3f(direction(rng) * 9.0), V3f(direction(rng))};
    Hit hit_a, hit_b;
    const bool hits = a.rays().intersect(ray, hit_a);
    EXPECT_EQ(hits, b.rays().intersect(ray, hit_b));
    ++d.rays;
    const std::uint32_t mesh_a =
        hit_a.instance == no_instance ? hit_a.mesh : 6 + hit_a.instance;  // in the copies
    if (mesh_a != hit_b.mesh || hit_a.triangle != hit_b.triangle) {
      ++d.others;
      continue;
    }
    const Surface at_a = a.surface(ray, hit_a), at_b = b.surface(ray, hit_b);
    d.point = std::max(d.point, max_abs_component(at_a.x - at_b.x));
    d.ng = std::max(d.ng, max_abs_component(at_a.ng - at_b.ng));
    d.ns = std::max(d.ns, max_abs_component(at_a.ns - at_b.ns));
    EXPECT_EQ(a.surface(hit_a, at_a.x).ns, at_a.ns);
    EXPECT_EQ(a.surface(hit_a, at_a.x).offset, at_a.offset);
  }
  return d;
}

TEST(Instances, HaveTheSurfacesOfCopies) {
  const ThreadPool pool(1);
  for (const bool stretched : {false, true}) {
    const Scene copies(copied(instances_of_spheres(40, stretched)), {}, {}, pool);
    const Scene instances(instances_of_spheres(40, stretched), {}, {}, pool);
    const Difference d = compare(instances, copies);
    EXPECT_LT(d.others, d.rays / 500);  // rays through edges
    EXPECT_LT(d.point, 1e-4F);
    EXPECT_LT(d.ng, 1e-5F);
    // Under a stretch, normals are interpolated before it, and those of copies after it.
    if (!stretched) {
      EXPECT_LT(d.ns, 1e-3F);  // barycentric coordinates differ by rounding
    }
    EXPECT_EQ(instances.data().triangle_count(), copies.data().triangle_count());
    EXPECT_LT(instances.data().stored_triangles(), copies.data().triangle_count() / 10);
  }
}

TEST(Instances, BoxContainsThem) {
  const SceneData data = instances_of_spheres(40, true);
  const Bounds box = data.bounds(), exact = copied(data).bounds();
  for (int k = 0; k < 3; ++k) {
    EXPECT_LE(box.low[k], exact.low[k]);
    EXPECT_GE(box.high[k], exact.high[k]);
  }
}

TEST(Instances, HaveTheTrianglesOfCopiesInTheAnalysis) {
  const SceneData data = instances_of_spheres(10, true);
  const TriangleSoup placed = triangle_soup(data), copies = triangle_soup(copied(data));
  ASSERT_EQ(placed.size(), copies.size());
  for (std::uint64_t i = 0; i < placed.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(V3f(placed.corners(i)[k]), V3f(copies.corners(i)[k]));
    }
  }
}

/// An instance of one triangle of 1e-2 to 1e2 units, up to 1e4 times its size away from the origin,
/// in a scene at least 1e2 times its size.
SceneData placed_triangle(Rng& rng) {
  SceneParts parts;
  const double size = logarithmic(rng, 1e-2, 1e2);
  Mesh mesh;
  for (int k = 0; k < 3; ++k) mesh.positions.emplace_back(direction(rng) * size);
  mesh.triangles = {{0, 1, 2}};
  mesh.material = parts.material(test::diffuse(Rgb(0.5F)));
  parts.data.meshes.push_back(std::move(mesh));
  parts.data.prototypes.push_back({0, 1});
  const V3d at = direction(rng) * size * logarithmic(rng, 1, 1e4);
  parts.data.instances.emplace_back(random_transform(rng, at, rng.next() < 0.5F, true), 0);
  const auto reach = static_cast<float>(3e2 * size);
  parts.data.instances[0].set_reach(std::max(reach, 2 * max_abs_component(V3f(at))));
  return std::move(parts.data);
}

struct Segments {
  int leaving = 0, arriving = 0;
  int left_hits = 0, arrived_hits = 0;  ///< those of them that hit the triangle
};

/// Rays from the triangle of an instance and segments to it, at `share` of the offset.
Segments blocked_segments(float share) {
  const ThreadPool pool(1);
  Rng rng(5, 0, 0, Rng::Purpose::test);
  Segments s;
  for (int i = 0; i < 600; ++i) {
    SceneData data = placed_triangle(rng);
    const TriangleShape shape(TriangleShape(data.meshes[0], 0), data.instances[0]);
    if (!(shape.area() > 0)) continue;
    const RayCaster rays(data, pool);
    for (int k = 0; k < 100; ++k) {
      const V2f b = sample_triangle(rng.next2());
      const V3f x = shape.at(b.x, b.y);
      const V3f ng = k % 2 == 0 ? shape.ng : -shape.ng;
      V3d w = direction(rng);
      if (w.dot(V3d(ng)) < 0) w = -w;
      const float offset = share * ray_offset(x, shape.ng, shape.plane_error);
      ++s.leaving;
      s.left_hits += rays.occluded({offset_origin(x, ng, offset, V3f(w)), V3f(w)}) ? 1 : 0;
      const auto size = std::sqrt(shape.area());
      const V3f from = x + V3f(w * (size * logarithmic(rng, 1e-2, 1e2)));
      const V3f back = (from - x).normalized();
      const float distance = (from - x).length();
      if (!(distance * abs_dot(back, ng) > 2 * offset)) continue;  // it may start behind the plane
      const V3f end = offset_end(x, shape.ng, offset, back, distance);
      ++s.arriving;
      s.arrived_hits += rays.occluded({from, end - from, 1}) ? 1 : 0;
    }
  }
  return s;
}

TEST(Instances, NoRayHitsTheTriangleThatItLeavesOrEndsAt) {
  const Segments s = blocked_segments(1);
  EXPECT_GT(s.leaving, 40000);
  EXPECT_GT(s.arriving, 40000);
  EXPECT_EQ(s.left_hits, 0);
  EXPECT_EQ(s.arrived_hits, 0);
}

TEST(Instances, TheOffsetIsNoLargerThanNeeded) { EXPECT_GT(blocked_segments(0.03F).left_hits, 0); }

}  // namespace
}  // namespace lacuna
