#include "renderer/many_lights/block_bounds.h"

#include <gtest/gtest.h>

#include "renderer/core/morton.h"
#include "renderer/core/rng.h"

namespace lacuna {
namespace {

V3f direction(Rng& rng) {
  return V3f(rng.next() - 0.5F, rng.next() - 0.5F, rng.next() - 0.5F).normalized();
}

// Never left out is what one light of the block could do; often enough it is left out.
TEST(BlockBounds, LeaveOutOnlyWhatNoLightOfTheBlockReaches) {
  Rng rng(1, 0, 0, Rng::Purpose::test);
  int behind = 0, turned = 0, further = 0;
  for (int n = 0; n < 20000; ++n) {
    BlockBounds bounds;
    std::array<V3f, 8> x, g;
    const V3f centre = 3.0F * direction(rng);
    const V3f facing = direction(rng);
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = centre + 0.5F * direction(rng);
      g[i] = (facing + 0.3F * direction(rng)).normalized();
      bounds.add({x[i], g[i]});
    }
    const V3f p = direction(rng);
    const V3f normal = direction(rng);
    const float reach = 5 * rng.next();
    bool in_front = false, faced = false, near = false;
    for (std::size_t i = 0; i < x.size(); ++i) {
      in_front = in_front || dot(normal, x[i] - p) > 0;
      faced = faced || dot(g[i], p - x[i]) > 0;
      near = near || (x[i] - p).length() <= reach;
    }
    const auto all = [](const V3f& v) { return Float8x3{v.x, v.y, v.z}; };
    const bool is_behind = any(bounds.behind(all(p), all(normal)));
    const bool is_turned = any(bounds.facing_away(all(p)));
    EXPECT_FALSE(is_behind && in_front);
    EXPECT_FALSE(is_turned && faced);
    const bool is_further = any(bounds.further_than(reach, all(p)));
    EXPECT_FALSE(is_further && near);
    further += is_further;
    behind += is_behind;
    turned += is_turned;
  }
  EXPECT_GT(behind, 5000);
  EXPECT_GT(turned, 3000);
  EXPECT_GT(further, 5000);
}

TEST(MortonOrder, KeepsEachAxisInOrder) {
  Bounds box;
  box.add(V3f{-1, -1, -1});
  box.add(V3f{1, 1, 3});
  const MortonOrder order(box);
  EXPECT_EQ(order({-1, -1, -1}), 0U);
  EXPECT_EQ(order({-1, -1, 3}), 0x4924924924924924U);
  for (const V3f& step : {V3f(0.01F, 0, 0), V3f(0, 0.01F, 0), V3f(0, 0, 0.01F)}) {
    EXPECT_GT(order(V3f(0.3F, 0.2F, 0.1F) + step), order({0.3F, 0.2F, 0.1F}));
  }
  Bounds point;
  point.add(V3f{1, 2, 3});
  EXPECT_EQ(MortonOrder(point)({1, 2, 3}), 0U);
}

}  // namespace
}  // namespace lacuna
