// Light paths from infinity start uniformly over what is seen of the scene's box from there.

#include <gtest/gtest.h>

#include "renderer/core/frame.h"
#include "renderer/emitters/light_le_sample.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

struct Crossing {
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
};

/// Where the line x + t d crosses the box, by its three slabs.
Crossing crossing(const Bounds& box, const V3d& x, const V3d& d) {
  Crossing c;
  for (int k = 0; k < 3; ++k) {
    if (d[k] == 0) {
      if (x[k] < box.low[k] || x[k] > box.high[k]) return {1, 0};
      continue;
    }
    const double a = (box.low[k] - x[k]) / d[k], b = (box.high[k] - x[k]) / d[k];
    c.enter = std::max(c.enter, std::min(a, b));
    c.leave = std::min(c.leave, std::max(a, b));
  }
  return c;
}

Bounds box_of(const V3f& low, const V3f& high) {
  Bounds b;
  b.add(low);
  b.add(high);
  return b;
}

EmitterPoint from_infinity(const Bounds& box, const V3f& to_light, EmitterPoint::Kind kind) {
  EmitterPoint e;
  e.kind = kind;
  e.x = to_light.normalized();
  e.emission = Rgb(1, 1, 1);
  e.pdf = Pdf<Area>(1);
  e.across = static_cast<float>(box.area_across(e.x));
  return e;
}

/// A grid of cells across a direction, which holds the box as seen from there.
class Across {
 public:
  static constexpr int cells = 16;  // a side

  Across(const Bounds& box, const V3f& w) : box_(box), frame_(w) {
    for (int corner = 0; corner < 8; ++corner) {
      V3d x = box.low;
      for (int k = 0; k < 3; ++k) {
        if ((corner >> k & 1) != 0) x[k] = box.high[k];
      }
      const Imath::V2d p = place(x);
      for (int k = 0; k < 2; ++k) {
        low_[k] = std::min(low_[k], p[k]);
        high_[k] = std::max(high_[k], p[k]);
      }
    }
  }
  std::size_t cell_of(const V3d& x) const {
    const Imath::V2d p = (place(x) - low_) / (high_ - low_) * cells;
    const auto at = [](double v) { return std::clamp(static_cast<int>(v), 0, cells - 1); };
    return static_cast<std::size_t>(at(p.y) * cells + at(p.x));
  }
  /// Area of the box as seen, in each cell, by counting points of a fine grid.
  std::vector<double> areas() const {
    constexpr int sub = 64;
    std::vector<double> areas(cells * cells);
    const Imath::V2d step = (high_ - low_) / (cells * sub);
    for (int j = 0; j < cells * sub; ++j) {
      for (int i = 0; i < cells * sub; ++i) {
        const Imath::V2d p = low_ + step * Imath::V2d(i + 0.5, j + 0.5);
        const V3d x = V3d(frame_.s) * p.x + V3d(frame_.t) * p.y;
        const Crossing c = crossing(box_, x, V3d(frame_.n));
        if (c.enter <= c.leave) {
          areas[static_cast<std::size_t>(j / sub * cells + i / sub)] += step.x * step.y;
        }
      }
    }
    return areas;
  }

 private:
  Imath::V2d place(const V3d& x) const { return {x.dot(V3d(frame_.s)), x.dot(V3d(frame_.t))}; }

  Bounds box_;
  Frame frame_;
  Imath::V2d low_{1e300}, high_{-1e300};
};

struct FromInfinity {
  const char* name;
  Bounds box;
  V3f to_light;
};

const std::vector<FromInfinity> from_everywhere{
    {"a face", box_of({0, 0, 0}, {1, 2, 3}), {0, 1, 0}},
    {"its back", box_of({0, 0, 0}, {1, 2, 3}), {0, -1, 0}},
    {"two faces", box_of({0, 0, 0}, {1, 2, 3}), {-1, 0, 1}},
    {"three faces", box_of({-4, 1, 2}, {-1, 2, 4}), {0.3F, -0.7F, 0.2F}},
    {"nearly along a face", box_of({0, 0, 0}, {1, 1, 1}), {1, 1e-3F, 0}},
    {"a flat box", box_of({0, 0, 0}, {3, 0, 2}), {0.2F, 0.5F, 0.3F}},
    {"a long box", box_of({0, 0, 0}, {100, 1, 0.1F}), {0.1F, 0.5F, 0.8F}},
    {"far from the origin", box_of({500, -300, 1000}, {502, -298, 1001}), {0.2F, 1, -0.4F}}};

TEST(Silhouette, PlacesAreUniformAndNoRayPassesTheBoxBy) {
  constexpr int draws = 100000;
  const double level = statistics::sidak(1e-6, from_everywhere.size());
  for (const FromInfinity& c : from_everywhere) {
    SCOPED_TRACE(c.name);
    const EmitterPoint e = from_infinity(c.box, c.to_light, EmitterPoint::Kind::directional);
    const Across grid(c.box, e.x);
    std::vector<double> observed(Across::cells * Across::cells);
    Rng rng(41, 0, 0, Rng::Purpose::test);
    const double slack = 1e-5 * (c.box.radius() + c.box.high.length());
    for (int i = 0; i < draws; ++i) {
      const auto l = sample_Le(e, c.box, rng);
      ASSERT_TRUE(l);
      ASSERT_EQ(l->ray.d, -e.x);
      ASSERT_EQ(l->pdf.value, 1 / e.across);
      Bounds wider = c.box;
      wider.low -= V3d(slack);
      wider.high += V3d(slack);
      const Crossing met = crossing(wider, V3d(l->ray.o), V3d(l->ray.d));
      ASSERT_LE(met.enter, met.leave) << "the ray passes the box by";
      ASSERT_GT(met.enter, 0) << "the ray starts inside the box";
      ++observed[grid.cell_of(V3d(l->ray.o))];
    }
    std::vector<double> expected = grid.areas();
    double sum = 0;
    for (const double a : expected) sum += a;
    // Where the silhouette is a sliver the fine grid is coarse itself.
    EXPECT_NEAR(sum / double(e.across), 1, 0.01);
    for (double& a : expected) a *= draws / sum;
    // Samples at the silhouette's edge may fall into cells that the fine grid's centres miss.
    for (std::size_t k = 0; k < expected.size(); ++k) {
      if (expected[k] == 0 && observed[k] > 0) expected[k] = 0.05;
    }
    const auto result = statistics::chi_square_test(observed, expected);
    EXPECT_GT(result.p, level) << result.message;
  }
}

TEST(Silhouette, AreaIsTheAreaSeen) {
  const Bounds box = box_of({0, 0, 0}, {1, 2, 3});
  EXPECT_DOUBLE_EQ(box.area_across(V3f(1, 0, 0)), 6);
  EXPECT_DOUBLE_EQ(box.area_across(V3f(0, 0, -1)), 2);
  // Cauchy: the mean over all directions is a quarter of the surface.
  Rng rng(42, 0, 0, Rng::Purpose::test);
  statistics::Moments mean;
  for (int i = 0; i < 100000; ++i) {
    const V2f u = rng.next2();
    const float z = 2 * u.x - 1, r = std::sqrt(1 - z * z);
    const float phi = 2 * pi * u.y;
    mean.add(box.area_across({r * std::cos(phi), r * std::sin(phi), z}));
  }
  EXPECT_GT(statistics::z_test(mean, 22.0 / 4), 1e-5);
  EXPECT_LT(mean.standard_error(), 0.01);
}

// A flat scene has no silhouette from within its own plane, and a scene without triangles none at
// all.
TEST(Silhouette, NothingLeavesWhereNothingIsSeen) {
  const Bounds flat = box_of({0, 0, 0}, {3, 0, 2});
  const Bounds point = box_of({1, 1, 1}, {1, 1, 1});
  Rng rng(43, 0, 0, Rng::Purpose::test);
  for (const auto kind : {EmitterPoint::Kind::directional, EmitterPoint::Kind::environment}) {
    for (int i = 0; i < 100; ++i) {
      const EmitterPoint along = from_infinity(flat, V3f(1, 0, -2), kind);
      EXPECT_EQ(along.across, 0);
      EXPECT_FALSE(sample_Le(along, flat, rng));
      EXPECT_FALSE(along.pdf_Le(-along.x).positive());
      EXPECT_FALSE(sample_Le(from_infinity(point, V3f(1, 2, 3), kind), point, rng));
    }
  }
}

}  // namespace
}  // namespace lacuna
