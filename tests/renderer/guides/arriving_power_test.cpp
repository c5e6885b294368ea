// The power and the importance that arrive in parts of the empty space, against solid angles and
// form factors (Noel 2015, eq. 172-176).

#include "renderer/guides/arriving_power.h"

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

#include "tests/renderer/scene/scene_parts.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

using test::SceneParts;

constexpr std::uint32_t part_count = 12;

double luminous(const Rgb& c) {
  return 0.2126 * double(c.x) + 0.7152 * double(c.y) + 0.0722 * double(c.z);
}

/// The voxels of the box [-1, 1]^3, each of a part of the space, by chance.
struct PartedBox {
  static constexpr int across = 8;

  PartedBox() : part(Imath::V3i(across)) {
    Rng rng(71, 0, 0, Rng::Purpose::test);
    for (std::size_t i = 0; i < part.count(); ++i) part[i] = rng.next_u32() % part_count;
  }
  SurfaceLookup lookup() const { return {transform, part}; }

  Grid3<std::uint32_t> part;
  GridTransform transform{V3d(-1.0), 2.0 / across};
};

/// The face of a voxel that lies on a wall of the box: on the lower or the upper side of `axis`.
struct WallSquare {
  int axis;
  bool upper;
  V3d low;  ///< the corner with the lowest coordinates
  std::uint32_t part;

  /// The corners, in order around it.
  std::array<V3d, 4> corners() const {
    V3d a(0.0), b(0.0);
    a[(axis + 1) % 3] = b[(axis + 2) % 3] = 2.0 / PartedBox::across;
    return {low, low + a, low + a + b, low + b};
  }
};

std::vector<WallSquare> wall_squares(const PartedBox& box) {
  constexpr int n = PartedBox::across;
  std::vector<WallSquare> all;
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool upper : {false, true}) {
      for (int i = 0; i < n * n; ++i) {
        Imath::V3i voxel(0), corner(0);
        voxel[axis] = upper ? n - 1 : 0;
        corner[axis] = upper ? n : 0;
        voxel[(axis + 1) % 3] = corner[(axis + 1) % 3] = i % n;
        voxel[(axis + 2) % 3] = corner[(axis + 2) % 3] = i / n;
        all.push_back({axis, upper, box.transform.to_world(V3d(corner)), box.part(voxel)});
      }
    }
  }
  return all;
}

/// The box' walls, but for the upper one of axis 2 if it is `open`.
void add_walls(SceneParts& p, bool open, const Material& material) {
  p.box({-1, -1, -1}, {1, 1, 1}, false, p.material(material));
  if (open) p.data.meshes.pop_back();
}
bool is_gap(const WallSquare& s, bool open) { return open && s.axis == 2 && s.upper; }

/// What arrives of `rays` rays that carry the same, `total` together, in parts of which each is
/// `expected` its power; the rest leaves the scene.
void expect_arrival(const std::vector<double>& found, std::vector<double> expected, double total,
                    int rays) {
  ASSERT_EQ(found.size(), expected.size());
  std::vector<double> observed;
  for (const double f : found) {
    const double hits = f / total * rays;
    EXPECT_NEAR(hits, std::round(hits), 3e-6 * rays) << "rays do not carry " << total / rays;
    observed.push_back(std::round(hits));
  }
  for (double& e : expected) e *= rays / total;
  const double left = rays - std::accumulate(expected.begin(), expected.end(), 0.0);
  EXPECT_GT(left, -1e-3 * rays);
  expected.push_back(left < 1e-3 * rays ? 0 : left);
  observed.push_back(rays - std::accumulate(observed.begin(), observed.end(), 0.0));
  const auto result = statistics::chi_square_test(observed, expected);
  EXPECT_GT(result.p, statistics::sidak(1e-4, 30)) << result.message;
}

/// The solid angle of a square, seen from `x`.
double solid_angle(const WallSquare& s, const V3d& x) {
  const V3d from = s.low - x, to = s.corners()[2] - x;
  const double d = std::abs(from[s.axis]);
  const auto corner = [&](double a, double b) {
    return std::atan(a * b / (d * std::sqrt(a * a + b * b + d * d)));
  };
  const int i = (s.axis + 1) % 3, k = (s.axis + 2) % 3;
  return corner(to[i], to[k]) - corner(from[i], to[k]) - corner(to[i], from[k]) +
         corner(from[i], from[k]);
}

/// The share of what a Lambertian point at `x` sends, around unit `n`, that arrives at a square all
/// of whose corners it sees (Lambert 1760): an integral of cos / pi over its solid angle.
double form_factor(const WallSquare& s, const V3d& x, const V3d& n) {
  const std::array<V3d, 4> corners = s.corners();
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const V3d a = (corners[i] - x).normalized(), b = (corners[(i + 1) % 4] - x).normalized();
    const V3d across = a.cross(b);
    sum += std::atan2(across.length(), a.dot(b)) * n.dot(across.normalized());
  }
  return std::abs(sum) / (2 * std::numbers::pi);
}

constexpr std::array ray_counts{1000, 4096, 40000};

TEST(ArrivingPower, OfAPointIsItsIntensityTimesTheSolidAngle) {
  const PartedBox box;
  const std::vector<WallSquare> squares = wall_squares(box);
  double sixth = 0;
  for (const WallSquare& s : squares) sixth += s.axis == 1 && s.upper ? solid_angle(s, V3d(0)) : 0;
  EXPECT_NEAR(sixth, 4 * std::numbers::pi / 6, 1e-12);

  const ThreadPool pool(2);
  const std::array<std::pair<V3f, Rgb>, 2> lights{
      {{{0.3F, -0.2F, 0.4F}, {2, 1, 4}}, {{-0.6F, 0.5F, -0.1F}, {2, 1, 4}}}};
  for (const bool open : {false, true}) {
    SceneParts p;
    add_walls(p, open, test::diffuse(Rgb(0.5F)));
    std::vector<double> expected(part_count);
    double total = 0;
    for (const auto& [x, intensity] : lights) {
      p.light(PunctualLight::Kind::point, x, {0, 0, -1}, intensity);
      total += 4 * std::numbers::pi * luminous(intensity);
      for (const WallSquare& s : squares) {
        if (!is_gap(s, open)) expected[s.part] += luminous(intensity) * solid_angle(s, V3d(x));
      }
    }
    const Scene scene = test::lit_scene(std::move(p.data));
    for (const int rays : ray_counts) {
      SCOPED_TRACE(testing::Message() << (open ? "open, " : "closed, ") << rays << " rays");
      expect_arrival(arriving_power(scene, box.lookup(), part_count, rays, pool), expected, total,
                     rays);
    }
  }
}

// Where it starts, not where it arrives: of points, of a lamp, and of light from infinity.
TEST(BrightestPart, IsThatOfTheEmitters) {
  const PartedBox box;
  const ThreadPool pool(1);
  const auto part_at = [&](const V3d& x) {
    return box.part(*voxel_at(box.transform.to_grid(x), box.part.size()));
  };
  const auto brightest = [&](SceneParts p) {
    return brightest_part(test::lit_scene(std::move(p.data)), box.lookup(), part_count, 1000, pool);
  };
  const auto points = [] {
    SceneParts p;
    add_walls(p, false, test::diffuse(Rgb(0.5F)));
    p.light(PunctualLight::Kind::point, {0.3F, -0.2F, 0.4F}, {0, 0, -1}, Rgb(1));
    p.light(PunctualLight::Kind::point, {-0.6F, 0.55F, -0.1F}, {0, 0, -1}, Rgb(8));
    p.light(PunctualLight::Kind::directional, {0, 0, 0}, {0, -1, 0}, Rgb(1000));
    return p;
  };
  EXPECT_EQ(brightest(points()), part_at({-0.6, 0.55, -0.1}));
  SceneParts lamp = points();  // a small one that shines down, in the middle of a voxel
  lamp.quad({0.62F, 0.62F, 0.62F}, {0.01F, 0, 0}, {0, 0, 0.01F},
            lamp.material(test::lamp(Rgb(1e7F))));
  EXPECT_EQ(brightest(std::move(lamp)), part_at({0.62, 0.62, 0.62}));
  SceneParts sun;
  add_walls(sun, true, test::diffuse(Rgb(0.5F)));
  sun.light(PunctualLight::Kind::directional, {0, 0, 0}, {0, 0, -1}, Rgb(1));
  const Scene scene = test::lit_scene(std::move(sun.data));
  const auto power = arriving_power(scene, box.lookup(), part_count, 1000, pool);
  EXPECT_EQ(brightest_part(scene, box.lookup(), part_count, 1000, pool),
            std::max_element(power.begin(), power.end()) - power.begin());
}

TEST(ArrivingPower, OfALampIsItsRadianceTimesTheFormFactor) {
  const PartedBox box;
  const ThreadPool pool(2);
  const Rgb radiance(3, 4, 5);
  const V3d low(-0.5, 0.5, -0.25), sides(0.75, 0, 0.75);
  for (const bool both_sides : {false, true}) {
    for (const bool open : {false, true}) {
      SceneParts p;
      add_walls(p, open, test::diffuse(Rgb(0.5F)));
      const auto shining = p.material(test::lamp(radiance, both_sides));
      p.quad(V3f(low), V3f(float(sides.x), 0, 0), V3f(0, 0, float(sides.z)), shining);  // downwards
      const double one_side = std::numbers::pi * luminous(radiance) * sides.x * sides.z;
      std::vector<double> expected(part_count);
      for (const WallSquare& s : wall_squares(box)) {
        const bool below = s.low.y < low.y;
        if (is_gap(s, open) || !(below || both_sides)) continue;
        constexpr int steps = 24;
        for (int k = 0; k < steps * steps; ++k) {
          const V3d at(k % steps + 0.5, 0, k / steps + 0.5);
          const double share = form_factor(s, low + sides * at / steps, V3d(0, below ? -1 : 1, 0));
          expected[s.part] += one_side * share / (steps * steps);
        }
      }
      const Scene scene = test::lit_scene(std::move(p.data));
      for (const int rays : ray_counts) {
        SCOPED_TRACE(testing::Message() << (both_sides ? "both sides, " : "one side, ")
                                        << (open ? "open, " : "closed, ") << rays << " rays");
        expect_arrival(arriving_power(scene, box.lookup(), part_count, rays, pool), expected,
                       (both_sides ? 2 : 1) * one_side, rays);
      }
    }
  }
}

// A floor, and above its right half a roof. The sun stands so that the roof's shadow covers the
// middle of the floor, and a fifth of what falls on the box around both passes left of the floor.
TEST(ArrivingPower, OfTheSunIsItsIrradianceTimesTheProjectedArea) {
  Grid3<std::uint32_t> part(Imath::V3i(4, 3, 4));
  for (std::size_t i = 0; i < part.count(); ++i) {
    const Imath::V3i v = part.voxel(i);
    part[i] = v.y == 0 ? static_cast<std::uint32_t>(v.x) : v.y == 2 ? 4 : 5;
  }
  SceneParts p;
  const auto grey = p.material(test::diffuse(Rgb(0.5F)));
  p.quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, grey);
  p.quad({0, 1, -1}, {0, 0, 2}, {1, 0, 0}, grey);
  const Rgb irradiance(3, 2, 1);
  p.light(PunctualLight::Kind::directional, {0, 0, 0}, {-1, -2, 0}, irradiance);
  const Scene scene = test::lit_scene(std::move(p.data));
  const ThreadPool pool(2);
  const double each = luminous(irradiance) * 2 / std::sqrt(5);  // of a unit of the floor
  for (const int rays : ray_counts) {
    SCOPED_TRACE(rays);
    const auto found = arriving_power(scene, {{V3d(-1, -0.25, -1), 0.5}, part}, 6, rays, pool);
    expect_arrival(found, {each, 0, 0, each, 2 * each, 0}, 5 * each, rays);
  }
}

TEST(ArrivingPower, ScalesWithTheEmission) {
  const PartedBox box;
  const ThreadPool pool(1);
  const auto power = [&](const Rgb& radiance) {
    SceneParts p;
    add_walls(p, true, test::diffuse(Rgb(0.5F)));
    p.quad({-0.5F, 0.5F, -0.25F}, {0.75F, 0, 0}, {0, 0, 0.75F}, p.material(test::lamp(radiance)));
    const Scene scene = test::lit_scene(std::move(p.data));
    return arriving_power(scene, box.lookup(), part_count, 5000, pool);
  };
  const auto one = power(Rgb(1, 1, 1));
  for (const Rgb& radiance : {Rgb(1e6F, 0, 0), Rgb(0, 1e-6F, 0), Rgb(0, 0, 3), Rgb(7, 8, 9)}) {
    const auto other = power(radiance);
    for (std::uint32_t i = 0; i < part_count; ++i) {
      EXPECT_NEAR(other[i], luminous(radiance) * one[i], 1e-5 * luminous(radiance) * one[i]);
    }
  }
}

TEST(ArrivingPower, IsTheSameForAnyNumberOfThreadsAndNoneWithoutLightsOrParts) {
  PartedBox box;
  const ThreadPool two(2);
  const auto closed_box = [&](bool is_lit) {
    SceneParts p;
    add_walls(p, false, test::diffuse(Rgb(0.5F)));
    if (is_lit) p.light(PunctualLight::Kind::point, {0.1F, 0.2F, 0.3F}, {0, 0, -1}, Rgb(1, 1, 1));
    // With as many threads as will be wanted: what the ray caster has bounds all.
    return Scene(std::move(p.data), {.emission = true}, std::nullopt, two);
  };
  const Scene dark = closed_box(false), lit = closed_box(true);
  const auto power = [&](const Scene& scene, int threads) {
    return arriving_power(scene, box.lookup(), part_count, 30000, ThreadPool(threads));
  };
  const std::vector<double> nothing(part_count, 0.0);
  EXPECT_NE(power(lit, 1), nothing);
  EXPECT_EQ(power(lit, 2), power(lit, 1));
  EXPECT_EQ(power(dark, 1), nothing);
  for (std::size_t i = 0; i < box.part.count(); ++i) box.part[i] = no_node;
  EXPECT_EQ(power(lit, 1), nothing);
}

// The eye looks straight at a wall, of which each voxel's square is the same share of the picture.
TEST(ArrivingImportance, IsTheShareOfThePicture) {
  const PartedBox box;
  const ThreadPool pool(2);
  for (const bool narrow : {false, true}) {  // a wall that fills the picture, or half of it
    SceneParts p;
    const auto mirror = p.material(test::metal(Rgb(1, 1, 1), 0));
    const V3d low = narrow ? V3d(-0.25, -0.5, -1) : V3d(-1, -1, -1);
    const V3d high = narrow ? V3d(0.75, 0.25, -1) : V3d(1, 1, -1);
    const V3f size(high - low);
    p.quad(V3f(low), {size.x, 0, 0}, {0, size.y, 0}, mirror);
    p.eye({0, 0, 0}, {0, 0, -1}, 2 * std::atan(0.5));
    const Camera camera(p.data.cameras.front(), 24, 16);  // sees [-0.75, 0.75] x [-0.5, 0.5]
    std::vector<double> expected(part_count);
    for (const WallSquare& s : wall_squares(box)) {
      const V3d middle = (s.low + s.corners()[2]) / 2;
      const bool is_there = middle.x > low.x && middle.x < high.x && middle.y > low.y &&
                            middle.y < high.y && s.axis == 2 && !s.upper;
      const bool is_seen = std::abs(middle.x) < 0.75 && std::abs(middle.y) < 0.5;
      if (is_there && is_seen) expected[s.part] += 1 / 24.0;
    }
    const Scene scene = test::lit_scene(std::move(p.data));
    for (const int rays : ray_counts) {
      SCOPED_TRACE(testing::Message() << (narrow ? "narrow, " : "wide, ") << rays << " rays");
      expect_arrival(arriving_importance(scene, camera, box.lookup(), part_count, rays, pool),
                     expected, 1, rays);
    }
  }
}

// Wherever it looks: the shares are counted on a fine grid over the picture.
TEST(ArrivingImportance, IsTheShareOfASlantingPicture) {
  const PartedBox box;
  const ThreadPool pool(2);
  SceneParts p;
  add_walls(p, false, test::diffuse(Rgb(0.5F)));
  p.eye({0.5, -0.3, 0.6}, {-0.4, 0.1, -1}, 1.7);
  const Camera camera(p.data.cameras.front(), 30, 10);
  std::vector<double> expected(part_count);
  constexpr int width = 1200, height = 400;
  for (int i = 0; i < width * height; ++i) {
    const float x = (static_cast<float>(i % width) + 0.5F) / 40;
    const float y = (static_cast<float>(i / width) + 0.5F) / 40;
    const Ray ray = camera.ray(x, y);
    double t = HUGE_VAL;
    for (int a = 0; a < 3; ++a) {
      const double wall = ray.d[a] > 0 ? 1 : -1;
      t = std::min(t, (wall - double(ray.o[a])) / double(ray.d[a]));
    }
    const auto voxel =
        voxel_at(box.transform.to_grid(V3d(ray.o) + t * V3d(ray.d)), box.part.size());
    expected[box.part(*voxel)] += 1.0 / (width * height);
  }
  const Scene scene = test::lit_scene(std::move(p.data));
  for (const int rays : ray_counts) {
    SCOPED_TRACE(rays);
    expect_arrival(arriving_importance(scene, camera, box.lookup(), part_count, rays, pool),
                   expected, 1, rays);
  }
}

}  // namespace
}  // namespace lacuna
