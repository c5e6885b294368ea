#include "renderer/path/path_reuse.h"

#include <gtest/gtest.h>

#include <limits>

#include "renderer/path/guide.h"
#include "renderer/path/tiles.h"
#include "tests/renderer/path/scenes.h"

namespace lacuna {
namespace {

/// Paths that share what they gather, as a film sees it.
class SharedLight : public testing::Test {
 protected:
  SharedLight() {
    for (std::size_t i = 0; i < EyeBatch::size; ++i) {
      const auto x = static_cast<float>(i % 8), y = static_cast<float>(i / 8);
      batch_.start(camera_, Rng(1, 0, i, Rng::Purpose::test), camera_.ray(x + 0.5F, y + 0.5F), i);
    }
    reuse_.begin(Rng(2, 0, 0, Rng::Purpose::test));
    Walk walk(scene_, guide_, {.max_depth = 2, .last_scatters = true, .split_depth = 3}, counters_);
    walk.trace_paths(batch_.states, [&](std::size_t i, int depth) {
      reuse_.reach(i, depth);
      if (depth == 2 && reuse_.shares(i)) sharing_.push_back(i);
      return true;
    });
  }

  /// Path `i` gathers `value` by next event estimation at its second vertex.
  void gather(std::size_t i, float value) {
    reuse_.set_next_event_direction(i, batch_.vertex(i, 2).wp);
    reuse_.add(i, 2, 3, Rgb(value));
  }
  Rgb finish() {
    Rgb sum(0, 0, 0);
    reuse_.finish(
        scene_.rays(), counters_,
        [&](std::uint32_t, const Rgb& value) { accumulate(sum, value, counters_); },
        [](std::uint32_t, int, const Rgb&) {});
    return sum;
  }

  SceneData data_ = test::load({"cornell"});
  const Camera camera_{data_.cameras.front(), 8, 8};
  const Scene scene_ = test::lit_scene(std::move(data_));
  const Guide guide_{};
  EyeBatch batch_{2};
  PathReuse reuse_{batch_, guide_, 16};
  std::vector<std::size_t> sharing_;
  Counters counters_;
};

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

TEST_F(SharedLight, CountsWhatIsGatheredAndNotFinite) {
  ASSERT_GT(sharing_.size(), 2U);
  gather(sharing_[0], 1);
  gather(sharing_[1], nan);
  gather(sharing_[2], std::numeric_limits<float>::infinity());
  EXPECT_FALSE(is_black(finish()));
  EXPECT_EQ(counters_.rejected, 2U);
}

// A second vertex that scatters what is not finite, at the least to its own pixel.
TEST_F(SharedLight, CountsWhatIsScatteredAndNotFinite) {
  ASSERT_GT(sharing_.size(), 0U);
  SurfaceParams broken;
  broken.base_color = Rgb(nan);
  broken.metallic = broken.transmission = broken.f90 = 0;
  broken.f0 = Rgb(0, 0, 0);
  Vertex& v = batch_.vertex(sharing_[0], 2);
  v.bsdf.emplace(broken, v.side(), v.side());
  gather(sharing_[0], 1);
  EXPECT_TRUE(is_black(finish()));
  EXPECT_GT(counters_.rejected, 0U);
}

}  // namespace
}  // namespace lacuna
