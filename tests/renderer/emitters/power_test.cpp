// What light paths carry away from an emitter is its power, and a path that meets an emitter finds
// the point that would have been drawn there.

#include <gtest/gtest.h>

#include <array>

#include "renderer/gltf/gltf_load.h"
#include "tests/renderer/scene/scene_parts.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

using test::lit_scene;
using test::SceneParts;

std::filesystem::path scene_file(const std::string& name) {
  return std::filesystem::path(LACUNA_SOURCE_DIR) / "jobs/scenes" / name;
}

using Power = Imath::Vec3<double>;

/// E of what the first edge carries, against the power of all emitters, for each channel.
void expect_power(const Scene& scene, const Power& expected, int draws, double useful) {
  std::array<statistics::Moments, 3> carried;
  Rng rng(51, 0, 0, Rng::Purpose::test);
  for (int i = 0; i < draws; ++i) {
    const EmitterPoint e = scene.emitters().sample(scene.emitters().choose(rng));
    const auto l = scene.emitters().sample_Le(e, rng);
    for (std::size_t c = 0; c < 3; ++c) {
      carried[c].add(l ? double(l->throughput[static_cast<int>(c)]) : 0.0);
    }
  }
  for (std::size_t c = 0; c < 3; ++c) {
    const double power = expected[static_cast<unsigned>(c)];
    const double off = std::abs(carried[c].mean() - power);
    // Rounding in float, where nothing varies.
    if (off > 1e-5 * power) {
      EXPECT_GT(statistics::z_test(carried[c], power), 1e-6)
          << "channel " << c << " carries " << carried[c].mean() << " of " << power;
    }
    EXPECT_LE(carried[c].standard_error(), useful * power) << "the test has no power";
  }
}

/// Power of the emitting triangles of a scene by quadrature over each.
Power power_of_meshes(const SceneData& data) {
  Power sum(0);
  for (const Mesh& mesh : data.meshes) {
    const Material& m = data.materials[mesh.material];
    if (!m.emits()) continue;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      constexpr int n = 128;  // n^2 equal triangles, by their centroids
      Power mean(0);
      const auto add = [&](double u, double v) {
        mean +=
            Power(emission(m, data.textures,
                           mesh.uvs_at(t, static_cast<float>(u / n), static_cast<float>(v / n))));
      };
      for (int i = 0; i < n; ++i) {
        for (int j = 0; i + j < n; ++j) {
          add(i + 1.0 / 3, j + 1.0 / 3);
          if (i + j + 1 < n) add(i + 2.0 / 3, j + 2.0 / 3);
        }
      }
      const double area = TriangleShape(mesh, t).area();
      sum += mean / (n * n) * area * std::numbers::pi * (m.double_sided ? 2 : 1);
    }
  }
  return sum;
}

PunctualLight punctual(PunctualLight::Kind kind) {
  PunctualLight l;
  l.kind = kind;
  l.intensity = Rgb(1, 3, 0.5F);
  l.position = V3f(0.2F, 0.4F, 0.6F);
  l.direction = V3f(1, -2, 0.5F).normalized();
  l.inner_cone = 0.2F;
  l.outer_cone = 0.6F;
  return l;
}

/// A closed box of side 2 with one light.
Scene with_light(const PunctualLight& light) {
  SceneParts parts;
  parts.box({-1, -1, -1}, {1, 1, 1}, false, parts.material(test::diffuse(Rgb(0.5F))));
  parts.data.lights = {light};
  return lit_scene(std::move(parts.data));
}

constexpr int enough = 200000;

TEST(Power, OfAreas) {
  for (const bool both : {false, true}) {
    SceneParts parts;
    parts.quad({0, 0, 0}, {2, 0, 0}, {1, 1, 1}, parts.material(test::lamp(Rgb(1, 2, 3), both)));
    parts.quad({0, 5, 0}, {0, 1, 0}, {3, 0, 0}, parts.material(test::lamp(Rgb(7, 0, 1))));
    const Power power = power_of_meshes(parts.data);
    // pi L A of the first, whose sides are (2, 0, 0) and (1, 1, 1).
    EXPECT_NEAR(power.y, std::numbers::pi * 2 * std::sqrt(8.0) * (both ? 2 : 1), 1e-5);
    expect_power(lit_scene(std::move(parts.data)), power, enough, 0.01);
  }
}

TEST(Power, OfTexturedAndMaskedFreeQuads) {
  const Scene scene = lit_scene(load_gltf(scene_file("sides.glb")));
  expect_power(scene, power_of_meshes(scene.data()), enough, 0.01);
}

TEST(Power, OfPoints) {
  const PunctualLight l = punctual(PunctualLight::Kind::point);
  expect_power(with_light(l), Power(l.intensity) * (4 * std::numbers::pi), 1000, 1e-5);
}

TEST(Power, OfSpots) {
  for (const auto& [inner, outer] :
       {std::pair(0.2F, 0.6F), std::pair(0.0F, 1.5F), std::pair(0.005F, 0.02F),
        std::pair(0.5F, 0.5F), std::pair(0.0F, 1e-3F), std::pair(9e-6F, 1e-5F)}) {
    PunctualLight l = punctual(PunctualLight::Kind::spot);
    l.inner_cone = inner;
    l.outer_cone = outer;
    // In long double, which keeps 1 - cos of the narrowest to nine digits. The integral of
    // ((c - c1) / (c0 - c1))^2 over the ramp is a third of it.
    const long double c0 = std::cos(static_cast<long double>(inner));
    const long double c1 = std::cos(static_cast<long double>(outer));
    const double solid_angle = 2 * std::numbers::pi * static_cast<double>((1 - c0) + (c0 - c1) / 3);
    expect_power(with_light(l), Power(l.intensity) * solid_angle, enough, 0.01);
  }
}

TEST(Power, OfDirections) {
  const PunctualLight l = punctual(PunctualLight::Kind::directional);
  const double across = 4 * (1 + 2 + 0.5) / std::sqrt(1 + 4 + 0.25);
  expect_power(with_light(l), Power(l.intensity) * across, 1000, 1e-5);
}

TEST(Power, OfAllTogether) {
  const Scene scene = lit_scene(load_gltf(scene_file("many_lights.glb")));
  Power power = power_of_meshes(scene.data());
  for (const PunctualLight& l : scene.data().lights) {
    double solid_angle = 4 * std::numbers::pi;
    if (l.kind == PunctualLight::Kind::spot) {
      const double c0 = std::cos(double(l.inner_cone)), c1 = std::cos(double(l.outer_cone));
      ASSERT_GT(c0 - c1, 1e-4);
      solid_angle = 2 * std::numbers::pi * (1 - c0 + (c0 - c1) / 3);
    }
    power += Power(l.intensity) * solid_angle;
  }
  expect_power(scene, power, enough, 0.01);
}

TEST(Power, OfTheSky) {
  SceneParts parts;
  parts.box({0, 0, 0}, {1, 2, 3}, true, parts.material(test::diffuse(Rgb(0.5F))));
  const Scene scene =
      lit_scene(std::move(parts.data), EnvironmentImage{scene_file("sky.hdr"), 2, 0.7F});
  Power power(0);
  constexpr int down = 1024, across = 2048;
  for (int j = 0; j < down; ++j) {
    for (int i = 0; i < across; ++i) {
      const double c = 1 - (j + 0.5) * 2 / down, s = std::sqrt(1 - c * c);
      const double phi = 2 * std::numbers::pi * (i + 0.5) / across;
      const V3f w(V3d(s * std::cos(phi), c, s * std::sin(phi)));
      power += Power(scene.emitters().background(w)) * scene.bounds().area_across(w);
    }
  }
  power *= 4 * std::numbers::pi / (down * across);
  expect_power(scene, power, enough, 0.01);
}

TEST(Hit, FindsThePointThatIsDrawn) {
  for (const char* name : {"sides.glb", "many_lights.glb", "cornell.glb"}) {
    const Scene scene = lit_scene(load_gltf(scene_file(name)));
    Rng rng(52, 0, 0, Rng::Purpose::test);
    int found = 0;
    for (int i = 0; i < 2000; ++i) {
      const EmitterPoint e = scene.emitters().sample(scene.emitters().choose(rng));
      if (e.delta()) continue;
      // From a little way in front of it, straight back.
      const float size = static_cast<float>(scene.bounds().radius());
      const float away = 1e-3F * size;
      Hit hit;
      const Ray ray{e.x + e.ng * away, -e.ng, 2 * away};
      if (!scene.rays().intersect(ray, hit)) continue;
      const Surface s = scene.surface(ray, hit);
      if ((s.x - e.x).length() > 1e-5F * size || dot(s.ng, e.ng) < 0.9999F) continue;
      const EmitterPoint h = scene.emitters().hit(s, scene.emitted(s, e.ng));
      ++found;
      EXPECT_EQ(h.kind, e.kind);
      EXPECT_EQ(h.pdf.value, e.pdf.value);
      EXPECT_EQ(h.pdf.value, scene.emitters().pdf(s.mesh, s.triangle).value);
      EXPECT_EQ(h.both_sides, e.both_sides);
      EXPECT_NEAR(h.offset, e.offset, 1e-6F * size);
      EXPECT_EQ(h.ng, e.ng);
      // The place differs by rounding, and so does a texture's value.
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(h.emission[c], e.emission[c], 0.01);
      EXPECT_NEAR(h.pdf_Le(e.ng).value, e.pdf_Le(e.ng).value, 1e-6);
    }
    EXPECT_GT(found, 500) << name;
  }
}

TEST(Hit, FindsTheDirectionThatIsDrawn) {
  const Scene scene = lit_scene(load_gltf(scene_file("open.glb")),
                                EnvironmentImage{scene_file("sky.hdr"), 3, 1.2F});
  Rng rng(53, 0, 0, Rng::Purpose::test);
  int apart = 0;
  constexpr int draws = 20000;
  for (int i = 0; i < draws; ++i) {
    const EmitterPoint e = scene.emitters().sample(scene.emitters().choose(rng));
    const EmitterPoint h = scene.emitters().hit_background(e.x);
    ASSERT_EQ(h.kind, e.kind);
    ASSERT_EQ(h.x, e.x);
    ASSERT_EQ(h.emission, e.emission);
    ASSERT_EQ(h.across, e.across);
    ASSERT_EQ(h.emission, scene.emitters().background(e.x));
    apart += std::abs(h.pdf.value / e.pdf.value - 1) > 1e-5F ? 1 : 0;
  }
  EXPECT_LT(apart, draws / 1000) << "only at a texel's border may the two round apart";
}

}  // namespace
}  // namespace lacuna
