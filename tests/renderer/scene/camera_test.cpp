#include "renderer/scene/camera.h"

#include <gtest/gtest.h>

#include "renderer/core/rng.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

constexpr int columns = 8, rows = 6;

CameraData straight_ahead() {
  CameraData data;
  data.name = "ahead";
  data.yfov = 1.2;
  return data;
}

/// Where on the film of straight_ahead() a ray passes, in pixels from the upper left corner.
Imath::V2d film_position(const Ray& ray) {
  const double pixel = 2 * std::tan(straight_ahead().yfov / 2) / rows;
  const V3d d(ray.d);
  return {d.x / -d.z / pixel + columns / 2.0, rows / 2.0 - d.y / -d.z / pixel};
}

TEST(Camera, RaysPassWhereTheyShould) {
  const Camera camera(straight_ahead(), columns, rows);
  for (const Imath::V2d& at : {Imath::V2d(0, 0), Imath::V2d(8, 6), Imath::V2d(2.25, 5.5)}) {
    const Ray ray = camera.ray(static_cast<float>(at.x), static_cast<float>(at.y));
    EXPECT_NEAR(ray.d.length(), 1, 1e-6);
    EXPECT_LT((film_position(ray) - at).length(), 1e-5);
  }
}

TEST(Camera, SamplesOfAPixelFollowItsFilter) {
  constexpr int cells = 20;  // a side, over two pixels
  constexpr int draws = 200000;
  const V2i pixel(2, 3);
  // The filter's share of [-1, x] about the pixel's centre.
  const auto box = [](double x) { return std::clamp(x + 0.5, 0.0, 1.0); };
  const auto tent = [](double x) {
    return x < 0 ? (1 + x) * (1 + x) / 2 : 1 - (1 - x) * (1 - x) / 2;
  };
  const auto p_value = [&](PixelFilter filter, auto&& share) {
    const Camera camera(straight_ahead(), columns, rows, filter);
    std::vector<double> observed(cells * cells), expected(cells * cells);
    const auto mass = [&](int i) {
      return share(2.0 * (i + 1) / cells - 1) - share(2.0 * i / cells - 1);
    };
    for (int y = 0; y < cells; ++y) {
      for (int x = 0; x < cells; ++x) {
        expected[static_cast<std::size_t>(y * cells + x)] = draws * mass(x) * mass(y);
      }
    }
    Rng rng(1, 0, 0, Rng::Purpose::test);
    for (int i = 0; i < draws; ++i) {
      const Imath::V2d at = film_position(camera.sample(pixel, rng.next2())) - Imath::V2d(pixel) -
                            Imath::V2d(0.5, 0.5);
      const auto cell = [&](double x) {
        return std::clamp(static_cast<int>(std::floor((x + 1) / 2 * cells)), 0, cells - 1);
      };
      ++observed[static_cast<std::size_t>(cell(at.y) * cells + cell(at.x))];
    }
    return statistics::chi_square_test(observed, expected).p;
  };
  const double level = statistics::sidak(1e-6, 2);
  EXPECT_GT(p_value(PixelFilter::box, box), level);
  EXPECT_GT(p_value(PixelFilter::tent, tent), level);
  EXPECT_LT(p_value(PixelFilter::tent, box), level) << "the test has no power";
}

TEST(Camera, CropIsAPartOfTheLargerPicture) {
  const Camera whole(straight_ahead(), columns, rows);
  const Camera part(straight_ahead(), 3, 2, PixelFilter::box, Crop{{4, 1}, {columns, rows}});
  EXPECT_EQ(part.width(), 3);
  const Ray a = part.ray(1.25F, 0.5F), b = whole.ray(5.25F, 1.5F);
  EXPECT_LT((a.d - b.d).length(), 1e-6F);
  EXPECT_FLOAT_EQ(part.density(a.d).value, whole.density(a.d).value);
  const auto at = part.project(a.d);
  ASSERT_TRUE(at.has_value());
  EXPECT_NEAR(at->x, 1.25F, 1e-4F);
  EXPECT_NEAR(at->y, 0.5F, 1e-4F);
  EXPECT_FALSE(part.project(whole.ray(3.5F, 1.5F).d).has_value());
}

TEST(Camera, UnknownNameIsRefusedWithThoseThereAre) {
  SceneData data;
  EXPECT_THROW(choose_camera(data, "", "a.glb"), SceneError);
  data.cameras = {straight_ahead()};
  EXPECT_EQ(choose_camera(data, "", "a.glb").name, "ahead");
  EXPECT_EQ(choose_camera(data, "ahead", "a.glb").name, "ahead");
  try {
    choose_camera(data, "behind", "a.glb");
    FAIL();
  } catch (const SceneError& e) {
    const std::string said = e.what();
    EXPECT_NE(said.find("a.glb"), std::string::npos);
    EXPECT_NE(said.find("\"behind\""), std::string::npos);
    EXPECT_NE(said.find("\"ahead\""), std::string::npos);
  }
}

}  // namespace
}  // namespace lacuna
