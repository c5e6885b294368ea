#include "renderer/geometry/ray_offset.h"

#include <gtest/gtest.h>

#include <numbers>

#include "renderer/core/rng.h"
#include "renderer/core/sampling.h"
#include "renderer/scene/close_surfaces.h"
#include "tests/renderer/scene/scene_parts.h"

namespace lacuna {
namespace {

using test::SceneParts;

Rng random_numbers() { return {59, 0, 0, Rng::Purpose::test}; }

double logarithmic(Rng& rng, double low, double high) {
  return low * std::pow(high / low, double(rng.next()));
}

V3d direction(Rng& rng) {
  const double z = 2 * double(rng.next()) - 1, phi = 2 * std::numbers::pi * double(rng.next());
  const double s = std::sqrt(1 - z * z);
  return {s * std::cos(phi), s * std::sin(phi), z};
}

/// What planes and shapes of triangles have in common that rounding depends on.
enum class Kind { any, across_an_axis, nearly_across_an_axis, needle, far_away };
constexpr std::array kinds{Kind::any, Kind::across_an_axis, Kind::nearly_across_an_axis,
                           Kind::needle, Kind::far_away};

V3d normal(Kind kind, Rng& rng) {
  const V3d n = direction(rng);
  if (kind == Kind::across_an_axis) return {0, 1, 0};
  if (kind == Kind::nearly_across_an_axis) return (V3d(0, 1, 0) + 1e-7 * n).normalized();
  return n;
}

/// A triangle of 1e-3 to 1e6 units, at the origin or beside it.
SceneData random_triangle(Kind kind, Rng& rng) {
  const double size = logarithmic(rng, 1e-3, 1e6);
  const V3d n = normal(kind, rng);
  const V3d a = n.cross(direction(rng)).normalized(), b = n.cross(a);
  const double width = kind == Kind::needle ? logarithmic(rng, 1e-4, 1) : 1;
  const double away = kind == Kind::far_away ? logarithmic(rng, 1, 1e4) : double(rng.next());
  const V3d centre = direction(rng) * (size * away);
  SceneParts parts;
  Mesh mesh;
  for (int k = 0; k < 3; ++k) {
    const auto along = [&] { return size * (2 * double(rng.next()) - 1); };
    const V3d x = centre + a * along() + b * (along() * width);
    mesh.positions.emplace_back(x);
  }
  mesh.triangles = {{0, 1, 2}};
  mesh.material = parts.material(test::diffuse(Rgb(0.5F)));
  parts.data.meshes.push_back(std::move(mesh));
  return std::move(parts.data);
}

/// A unit direction above the plane, often a grazing one.
V3f above(const V3f& ng, Rng& rng) {
  const V3d n(ng);
  const double cosine = rng.next() < 0.5F ? double(rng.next()) : logarithmic(rng, 1e-4, 1);
  V3d t = direction(rng);
  t = (t - n * t.dot(n)).normalized();
  return V3f(t * std::sqrt(1 - cosine * cosine) + n * cosine);
}

struct Hits {
  int rays = 0, own = 0;
};

/// Rays that leave a triangle at `share` of their offset, and those of them that hit it.
Hits leave_triangles(Kind kind, float share) {
  const ThreadPool pool(1);
  Rng rng = random_numbers();
  Hits hits;
  for (int i = 0; i < 300; ++i) {
    SceneData data = random_triangle(kind, rng);
    const TriangleShape shape(data.meshes[0], 0);
    if (!(shape.area() > 0)) continue;
    const RayCaster rays(data, pool);
    for (int k = 0; k < 200; ++k) {
      const V2f b = sample_triangle(rng.next2());
      const V3f x = shape.at(b.x, b.y);
      const V3f ng = k % 2 == 0 ? shape.ng : -shape.ng;
      const V3f w = above(ng, rng);
      if (!(dot(w, ng) > 0)) continue;
      const float offset = share * ray_offset(x, shape.ng, shape.plane_error);
      ++hits.rays;
      hits.own += rays.occluded({offset_origin(x, shape.ng, offset, w), w}) ? 1 : 0;
    }
  }
  return hits;
}

TEST(RayOffset, NoRayHitsTheTriangleThatItLeaves) {
  for (const Kind kind : kinds) {
    const Hits hits = leave_triangles(kind, 1);
    EXPECT_GT(hits.rays, 50000) << int(kind);
    EXPECT_EQ(hits.own, 0) << int(kind);
  }
}

TEST(RayOffset, IsNoLargerThanNeeded) {
  for (const Kind kind : {Kind::any, Kind::needle, Kind::far_away}) {
    EXPECT_GT(leave_triangles(kind, 0.1F).own, 0) << int(kind);
  }
}

TEST(RayOffset, IsZeroOnAFloorAtHeightZeroOfAnySize) {
  for (const float size : {1.0F, 1e4F, 1e6F}) {
    SceneParts parts;
    parts.quad({-size, 0, size}, {2 * size, 0, 0}, {0, 0, -2 * size}, parts.material(Material{}));
    const TriangleShape shape(parts.data.meshes[0], 1);
    EXPECT_EQ(shape.plane_error, 0);
    EXPECT_EQ(ray_offset({size / 3, 0, size / 7}, shape.ng, 0), 0);
  }
}

/// A segment between two surfaces that see each other hits neither.
TEST(RayOffset, SegmentsEndBeforeTheirSurface) {
  const ThreadPool pool(1);
  Rng rng = random_numbers();
  int segments = 0, blocked = 0;
  for (int i = 0; i < 300; ++i) {
    const Kind kind = kinds[static_cast<std::size_t>(i) % kinds.size()];
    SceneData data = random_triangle(kind, rng);
    const TriangleShape shape(data.meshes[0], 0);
    if (!(shape.area() > 0)) continue;
    const RayCaster rays(data, pool);
    for (int k = 0; k < 200; ++k) {
      const V2f b = sample_triangle(rng.next2());
      const V3f x = shape.at(b.x, b.y);
      const V3f w = above(shape.ng, rng);
      const float size = std::sqrt(static_cast<float>(shape.area()));
      const V3f from = x + w * (size * static_cast<float>(logarithmic(rng, 1e-2, 1e3)));
      const V3f edge = from - x;
      const float distance = edge.length();
      const V3f back = edge / distance;
      const float offset = ray_offset(x, shape.ng, shape.plane_error);
      if (!(distance * dot(back, shape.ng) > 2 * offset))
        continue;  // it may start behind the plane
      const V3f end = offset_end(x, shape.ng, offset, back, distance);
      ++segments;
      blocked += rays.occluded({from, end - from, 1.0F}) ? 1 : 0;
    }
  }
  EXPECT_GT(segments, 40000);
  EXPECT_EQ(blocked, 0);
}

/// On a floor of 1,000 km barycentric coordinates resolve 6 cm, and the distance along a ray from
/// 1 m above it a ten thousandth of a millimetre.
TEST(Surface, IsWhereTheRayHitsHoweverLargeTheTriangle) {
  for (const float size : {1.0F, 1e3F, 1e6F}) {
    SceneParts parts;
    parts.quad({-size, 0, size}, {2 * size, 0, 0}, {0, 0, -2 * size},
               parts.material(test::diffuse(Rgb(0.5F))));
    const Scene scene = test::lit_scene(std::move(parts.data));
    Rng rng = random_numbers();
    for (int i = 0; i < 1000; ++i) {
      const V3f from(rng.next(), 1, rng.next()), w = -above(V3f(0, 1, 0), rng);
      if (!(std::abs(w.y) > 0.01F)) continue;
      const Ray ray{from, w};
      Hit hit;
      if (!scene.rays().intersect(ray, hit)) continue;
      const Surface s = scene.surface(ray, hit);
      const V3d exact = V3d(from) + V3d(w) * (-1 / double(w.y));
      EXPECT_LT((V3d(s.x) - exact).length(), 1e-7 * exact.length()) << size;
      EXPECT_EQ(s.x.y, 0);
    }
  }
}

/// The sun, 45 degrees high, casts the shadow of a sheet onto the floor `gap` below it.
TEST(RayOffset, ShadowsOfContactsUnderLargeFloors) {
  constexpr float half = 0.05F;
  for (const float size : {2.0F, 300.0F, 1e4F, 1e5F, 1e6F}) {
    for (const float gap : {1e-6F, 1e-4F, 3e-3F, 0.1F, 1.0F}) {
      SceneParts parts;
      const auto material = parts.material(test::diffuse(Rgb(0.5F)));
      parts.quad({-size, 0, size}, {2 * size, 0, 0}, {0, 0, -2 * size}, material);
      parts.quad({-half, gap, half}, {2 * half, 0, 0}, {0, 0, -2 * half}, material);
      const Scene scene = test::lit_scene(std::move(parts.data));
      const V3f sun = V3f(1, 1, 0).normalized();
      Rng rng = random_numbers();
      for (int i = 0; i < 200; ++i) {
        const float x = 0.2F * (2 * rng.next() - 1) - gap, z = 0.1F * (2 * rng.next() - 1);
        const Ray down{{x, gap / 2, z}, {0, -1, 0}};
        Hit hit;
        ASSERT_TRUE(scene.rays().intersect(down, hit));
        const Surface s = scene.surface(down, hit);
        const float across = std::max(std::abs(x + gap), std::abs(z));
        if (std::abs(across - half) < 1e-4F) continue;
        EXPECT_EQ(scene.rays().occluded({offset_origin(s.x, s.ng, s.offset, sun), sun}),
                  across < half)
            << size << " " << gap << " at " << s.x;
      }
    }
  }
}

/// A sheet `gap` above a floor of half side `size`, both tilted, or moved by `height`.
SceneData sheet_over_floor(float size, float gap, bool tilted, float height) {
  const V3d up = tilted ? V3d(0.3, 0.9, 0.2).normalized() : V3d(0, 1, 0);
  const V3d a = up.cross(V3d(0, 0, 1)).normalized(), b = up.cross(a);
  SceneParts parts;
  const auto material = parts.material(test::diffuse(Rgb(0.5F)));
  const auto quad = [&](double half, double above, const char* name) {
    const V3d o = up * above + V3d(0, double(height), 0) - (a + b) * half;
    parts.quad(V3f(o), V3f(b * (2 * half)), V3f(a * (2 * half)), material);
    parts.data.meshes.back().name = name;
  };
  quad(size, 0, "floor");
  quad(0.05, gap, "sheet");
  return std::move(parts.data);
}

TEST(CloseSurfaces, AreWarnedOfWhereRaysDoNotResolveThem) {
  const auto warned = [](float size, float gap, bool tilted, float height) {
    return close_surfaces(test::lit_scene(sheet_over_floor(size, gap, tilted, height)),
                          ThreadPool(1));
  };
  for (const float size : {2.0F, 1e4F, 1e6F}) {
    for (const float gap : {1e-6F, 1e-3F, 1.0F}) {
      EXPECT_TRUE(warned(size, gap, false, 0).empty()) << size << " " << gap;
      const float resolved = 0x1p-21F * size;
      if (gap > 2 * resolved) {
        EXPECT_TRUE(warned(size, gap, true, 0).empty()) << size << " " << gap;
      } else if (gap < resolved / 8) {
        const auto said = warned(size, gap, true, 0);
        ASSERT_EQ(said.size(), 1U) << size << " " << gap;
        EXPECT_NE(said[0].find("\"sheet\""), std::string::npos) << said[0];
        EXPECT_NE(said[0].find("\"floor\""), std::string::npos) << said[0];
      }
    }
  }
  EXPECT_EQ(warned(10, 1e-6F, false, 1000).size(), 1U);
  EXPECT_TRUE(warned(10, 1e-3F, false, 1000).empty());
}

}  // namespace
}  // namespace lacuna
