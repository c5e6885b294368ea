// Which lobes give a vertex its letter in path expressions.

#include <gtest/gtest.h>

#include "renderer/core/rng.h"
#include "renderer/materials/bsdf.h"

namespace lacuna {
namespace {

const V3f normal(0, 0, 1);

V3f direction(float degrees) {
  const float a = degrees * std::numbers::pi_v<float> / 180;
  return {std::sin(a), 0, std::cos(a)};
}

SurfaceParams plastic(float alpha) {
  SurfaceParams p;
  p.base_color = Rgb(0.3F);
  p.alpha = alpha;
  return p;
}

TEST(MostlyDiffuse, IsPlasticButForItsHighlight) {
  const Lobes lobes(plastic(0.04F));
  const Bsdf bsdf(lobes, normal, normal);
  EXPECT_FALSE(bsdf.mostly_diffuse(direction(40), direction(-40)));
  EXPECT_TRUE(bsdf.mostly_diffuse(direction(40), direction(20)));
  EXPECT_TRUE(bsdf.mostly_diffuse(direction(40), direction(40)));
}

TEST(MostlyDiffuse, IsLambertAndNoMetalOrGlass) {
  const Lobes lambert(Rgb(0.5F));
  EXPECT_TRUE(Bsdf(lambert, normal, normal).mostly_diffuse(direction(10), direction(70)));
  SurfaceParams metal = plastic(0.5F);
  metal.metallic = 1;
  const Lobes rough(metal);
  SurfaceParams glass = plastic(0.3F);
  glass.transmission = 1;
  const Lobes frosted(glass);
  Rng rng(1, 0, 0, Rng::Purpose::test);
  for (int k = 0; k < 100; ++k) {
    const V3f eye = sample_cosine(normal, rng.next2()), light = sample_cosine(normal, rng.next2());
    EXPECT_FALSE(Bsdf(rough, normal, normal).mostly_diffuse(eye, light));
    EXPECT_FALSE(Bsdf(frosted, normal, normal).mostly_diffuse(eye, -light));
  }
}

TEST(MostlyDiffuse, IsASmoothLayersBaseFromAllSides) {
  const Lobes lobes(plastic(0));
  const Bsdf bsdf(lobes, normal, normal);
  EXPECT_TRUE(bsdf.mostly_diffuse(direction(40), direction(-40)));
}

TEST(MostlyDiffuse, IsWhatLambertsLobesPassToTheOtherSide) {
  SurfaceParams leaf = plastic(0.04F);
  leaf.diffuse_transmission = 0.5F;
  const Lobes lobes(leaf);
  const Bsdf bsdf(lobes, normal, normal);
  EXPECT_TRUE(bsdf.mostly_diffuse(direction(40), -direction(10)));
  EXPECT_TRUE(bsdf.mostly_diffuse(direction(40), direction(10)));
  EXPECT_FALSE(bsdf.mostly_diffuse(direction(40), direction(-40)));
}

TEST(MostlyDiffuse, IsTheSameIfEyeAndLightChangePlaces) {
  const Lobes lobes(plastic(0.2F));
  const Bsdf bsdf(lobes, normal, normal);
  Rng rng(2, 0, 0, Rng::Purpose::test);
  int diffuse = 0, different = 0;
  for (int k = 0; k < 2000; ++k) {
    const V3f a = sample_cosine(normal, rng.next2()), b = sample_cosine(normal, rng.next2());
    diffuse += bsdf.mostly_diffuse(a, b) ? 1 : 0;
    different += bsdf.mostly_diffuse(a, b) != bsdf.mostly_diffuse(b, a) ? 1 : 0;
  }
  EXPECT_LE(different, 1) << "but for rounding at the boundary";
  EXPECT_GT(diffuse, 100);
  EXPECT_LT(diffuse, 1990);
}

}  // namespace
}  // namespace lacuna
