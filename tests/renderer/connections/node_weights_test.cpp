// w_n(y) of Noel 2015, eq. 187, and which light vertices there are.

#include "renderer/connections/node_weights.h"

#include <gtest/gtest.h>

#include "tests/renderer/connections/lit_scene.h"

namespace lacuna {
namespace {

using test::Lit;

double lum(const Rgb& c) {
  return 0.2126 * double(c.x) + 0.7152 * double(c.y) + 0.0722 * double(c.z);
}

/// A point in or around the scene's box, which may be flat.
V3f place_in(const Bounds& box, Rng& rng) {
  const V3d share(rng.next(), rng.next(), rng.next());
  const V3d rim(box.radius() * 0.1);
  return V3f(box.low - rim + share * (box.size() + 2.0 * rim));
}

/// Whether a connecting edge could carry anything: a mirror, smooth glass and what is black cannot.
bool scatters_anywhere(const Vertex& v) {
  Rng rng(104, 0, 0, Rng::Purpose::test);
  for (int i = 0; i < 100; ++i) {
    const V2f u = rng.next2();
    const float z = 2 * u.x - 1, r = std::sqrt(1 - z * z);
    const V3f w(r * std::cos(2 * pi * u.y), r * std::sin(2 * pi * u.y), z);
    if (!is_black(v.bsdf->eval(v.wp, w, Transport::importance))) return true;
  }
  return false;
}

TEST(LightVertices, ListWhatCanBeJoined) {
  for (const test::PathScene& s : test::path_scenes()) {
    SCOPED_TRACE(s.name);
    const Lit lit(s);
    EXPECT_LE(lit.lights.count(1), std::size_t{Lit::paths});
    for (int count = 2; count <= lit.lights.longest(); ++count) {
      std::size_t i = 0;
      for (const auto& path : lit.walked) {
        const auto k = static_cast<std::size_t>(count) - 2;
        if (path.size() <= k || !scatters_anywhere(path[k])) continue;
        ASSERT_LT(i, lit.lights.count(count));
        const Vertex& v = lit.lights.at(count, i++);
        EXPECT_EQ(v.surface.x, path[k].surface.x);
        EXPECT_EQ(v.throughput, path[k].throughput);
        EXPECT_EQ(v.mis_partial, path[k].mis_partial);
      }
      EXPECT_EQ(i, lit.lights.count(count)) << "vertices " << count;
    }
  }
}

TEST(NodeWeights, AreWhatIsCarriedOverTheSquaredDistance) {
  constexpr double least = 0.05;
  Rng rng(102, 0, 0, Rng::Purpose::test);
  int positive = 0, turned_away = 0, close = 0;
  for (const test::PathScene& s : test::path_scenes()) {
    SCOPED_TRACE(s.name);
    const Lit lit(s);
    for (int trial = 0; trial < 10; ++trial) {
      V3f x = place_in(lit.scene.bounds(), rng);
      for (int count = 1; count <= lit.lights.longest(); ++count) {
        const std::size_t n = lit.lights.count(count);
        // Once in a while right beside a light vertex.
        if (trial == 0 && count == 2 && n > 0) {
          x = lit.lights.at(2, 0).surface.x + V3f(0.01F, 0.02F, 0.01F);
        }
        const auto all = node_weights(lit.lights, count, x, least, LightSides::both);
        const auto facing = node_weights(lit.lights, count, x, least, LightSides::facing);
        ASSERT_EQ(all.size(), n);
        ASSERT_EQ(facing.size(), n);
        for (std::size_t i = 0; i < n; ++i) {
          double carried = 0, d2 = 1;
          bool faces = true;
          if (count == 1) {
            const EmitterPoint& e = lit.lights.emitter(i);
            const V3d to = V3d(x) - V3d(e.x);
            carried = lum(e.emission) / double(e.pdf.value);
            if (!e.infinite()) {
              d2 = std::max(to.length2(), least * least);
              close += to.length2() < least * least ? 1 : 0;
            }
            if (e.kind == EmitterPoint::Kind::area && !e.both_sides) {
              faces = to.dot(V3d(e.ng)) > 0;
            }
            // A spot shines less beside its axis.
            if (e.kind == EmitterPoint::Kind::spot) {
              EXPECT_LE(facing[i], all[i]);
              continue;
            }
          } else {
            const Vertex& v = lit.lights.at(count, i);
            const V3d to = V3d(x) - V3d(v.surface.x);
            carried = lum(v.throughput);
            d2 = std::max(to.length2(), least * least);
            close += to.length2() < least * least ? 1 : 0;
            const bool opaque = lit.scene.material(v.surface).transmission == 0;
            faces = !opaque || to.dot(V3d(v.surface.ng)) * V3d(v.wp).dot(V3d(v.surface.ng)) > 0;
          }
          EXPECT_NEAR(all[i], carried / d2, 1e-5 * carried / d2);
          EXPECT_NEAR(facing[i], faces ? carried / d2 : 0, 1e-5 * carried / d2);
          ++(faces ? positive : turned_away);
        }
      }
    }
  }
  EXPECT_GT(positive, 10000);
  EXPECT_GT(turned_away, 1000);
  EXPECT_GT(close, 5) << "the least distance was never of use";
}

/// Whether nothing is met within `distance` along `w`.
bool sees(const Scene& scene, const V3f& x, const V3f& w, float distance) {
  Hit hit;
  return !scene.rays().intersect({x, w, distance}, hit);
}

TEST(NodeWeights, RaysLeadToTheVertices) {
  Rng rng(103, 0, 0, Rng::Purpose::test);
  int open = 0, blocked = 0, apart = 0;
  for (const test::PathScene& s : test::path_scenes()) {
    SCOPED_TRACE(s.name);
    const Lit lit(s);
    for (int trial = 0; trial < 10; ++trial) {
      const V3f x = place_in(lit.scene.bounds(), rng);
      for (int count = 1; count <= lit.lights.longest(); ++count) {
        const std::vector<Ray> rays = rays_to(lit.lights, count, x);
        ASSERT_EQ(rays.size(), lit.lights.count(count));
        for (std::size_t i = 0; i < rays.size(); ++i) {
          const bool clear = !lit.scene.rays().occluded(rays[i]);
          bool expected = false;
          if (count == 1 && lit.lights.emitter(i).infinite()) {
            expected = sees(lit.scene, x, lit.lights.emitter(i).x, HUGE_VALF);
          } else {
            const V3f y = count == 1 ? lit.lights.emitter(i).x : lit.lights.at(count, i).surface.x;
            const V3f w = (y - x).normalized();
            expected = sees(lit.scene, x, w, (y - x).length() * 0.999F);
          }
          ++(expected ? open : blocked);
          apart += clear == expected ? 0 : 1;
        }
      }
    }
  }
  EXPECT_GT(open, 1000);
  EXPECT_GT(blocked, 1000);
  // What lies right in front of the vertex, or is hit edge on.
  EXPECT_LT(apart, (open + blocked) / 200);
}

}  // namespace
}  // namespace lacuna
