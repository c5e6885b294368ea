#include "renderer/emitters/light_node.h"

#include <gtest/gtest.h>

#include <vector>

#include "renderer/core/rng.h"

namespace lacuna {
namespace {

std::array<float, 8> lanes_of(__m256 v) {
  std::array<float, 8> out;
  _mm256_storeu_ps(out.data(), v);
  return out;
}

V3d any_place(Rng& rng, double size) {
  return V3d(rng.next_choice() - 0.5, rng.next_choice() - 0.5, rng.next_choice() - 0.5) * size;
}

EmitterBounds emitter_at(const V3d& low, const V3d& size, double intensity) {
  EmitterBounds e;
  e.box.add(V3f(low));
  e.box.add(V3f(low + size));
  e.intensity = intensity;
  e.reach = std::numbers::pi / 2;
  return e;
}

/// The decoded sphere of each child contains the child's box.
void expect_spheres_around(const LightNode& node, std::span<const EmitterBounds> children) {
  const std::array centres{lanes_of(node.centres(0, 0)), lanes_of(node.centres(1, 0)),
                           lanes_of(node.centres(2, 0))};
  const auto radii = lanes_of(node.radii());
  for (std::size_t k = 0; k < children.size(); ++k) {
    const V3d centre{double(centres[0][k]), double(centres[1][k]), double(centres[2][k])};
    for (int corner = 0; corner < 8; ++corner) {
      V3d p;
      for (int a = 0; a < 3; ++a) {
        p[a] = (corner >> a & 1) != 0 ? children[k].box.high[a] : children[k].box.low[a];
      }
      ASSERT_LE((p - centre).length(), double(radii[k])) << k;
    }
  }
}

TEST(LightNode, SpheresContainTheirChildren) {
  Rng rng(1, 0, 0, Rng::Purpose::test);
  for (const double size : {1e-12, 1e-3, 1.0, 1e6, 1e15}) {
    for (const double offset : {0.0, 1.0, 1e4}) {
      for (std::size_t n = 1; n <= 8; ++n) {
        std::vector<EmitterBounds> children;
        for (std::size_t k = 0; k < n; ++k) {
          const V3d low = any_place(rng, size) + V3d(1, 2, -3) * (offset * size);
          children.push_back(emitter_at(low, any_place(rng, size * rng.next_choice()), 1));
        }
        expect_spheres_around(LightNode(children), children);
      }
    }
  }
}

// A row, a plane, and one place for all.
TEST(LightNode, FlatGroupsHaveSpheresToo) {
  for (const V3d& along : {V3d(1, 0, 0), V3d(0, 1e-7, 1), V3d(0, 0, 0)}) {
    std::vector<EmitterBounds> children;
    for (int k = 0; k < 8; ++k) {
      children.push_back(emitter_at(V3d(5, 5, 5) + along * double(k), V3d(0, 0, 0), 1));
    }
    expect_spheres_around(LightNode(children), children);
  }
}

// Intensities keep their ratios to 2^-10, over 24 decades, and are never 0.
TEST(LightNode, IntensitiesKeepTheirRatios) {
  std::vector<EmitterBounds> children;
  for (const double i : {1e12, 3.3e8, 1.0, 7e-3, 1e-12, 1e-40}) {
    children.push_back(emitter_at(V3d(i > 1 ? 1 : 0, 0, 0), V3d(0, 0, 0), i));
  }
  const auto intensity = lanes_of(LightNode(children).intensities());
  for (std::size_t k = 0; k < children.size(); ++k) {
    const double exact = std::max(children[k].intensity / 1e12, 0x1p-100);
    EXPECT_NEAR(double(intensity[k]) / exact, 1, 0x1p-10) << k;
  }
  for (std::size_t k = children.size(); k < 8; ++k) EXPECT_EQ(intensity[k], 0);
}

TEST(LightNode, NodesAreNumberedFromTheFirst) {
  LightNode node;
  node.first = 100;
  node.nodes = 0b10110100;
  EXPECT_FALSE(node.is_node(0));
  EXPECT_EQ(node.node(2), 100U);
  EXPECT_EQ(node.node(4), 101U);
  EXPECT_EQ(node.node(5), 102U);
  EXPECT_EQ(node.node(7), 103U);
}

}  // namespace
}  // namespace lacuna
