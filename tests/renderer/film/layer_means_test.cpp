#include "renderer/film/layer_means.h"

#include <gtest/gtest.h>

#include <limits>

#include "analysis/space/memory_limit.h"
#include "base/storage/bytes.h"
#include "renderer/core/rng.h"
#include "renderer/film/film.h"

namespace lacuna {
namespace {

const std::vector<std::string> two_names{"a", "b"};
constexpr int width = 5, height = 4;

const ThreadPool& pool() {
  static const ThreadPool two(2);
  return two;
}

LayerMeans empty_means() { return {two_names, width, height, no_memory_limit}; }

/// Iteration `i` of layer `layer`: noise about a level of its own.
Image estimate(std::uint64_t i, std::uint64_t layer) {
  Image image(width, height);
  Rng rng(3, i, layer, Rng::Purpose::test);
  const float level = layer == 0 ? 1e-3F : 1e6F;
  for (Rgb& p : image.pixels) p = level * Rgb(rng.next(), -rng.next(), 1 + rng.next());
  return image;
}

void add(LayerMeans& means, std::uint64_t first, std::uint64_t last) {
  for (std::uint64_t i = first; i < last; ++i) {
    const std::span<Image> images = means.begin(pool());
    for (std::size_t k = 0; k < images.size(); ++k) {
      const Image values = estimate(i, k);
      for (std::size_t p = 0; p < values.pixels.size(); ++p) {
        images[k].pixels[p] += values.pixels[p];
      }
    }
    means.add(pool());
  }
}

TEST(LayerMeans, AreThoseThatAFilmOfEachWouldHave) {
  LayerMeans means = empty_means();
  add(means, 0, 1000);
  for (std::size_t k = 0; k < two_names.size(); ++k) {
    Film film(width, height);
    for (std::uint64_t i = 0; i < 1000; ++i) film.add(i, estimate(i, k));
    const std::vector<double> mean = means.mean(k), expected = film.mean();
    ASSERT_EQ(mean.size(), expected.size());
    for (std::size_t v = 0; v < mean.size(); ++v) {
      EXPECT_NEAR(mean[v], expected[v], 1e-12 * std::abs(expected[v]));
    }
  }
}

TEST(LayerMeans, BeginBlackAndForgetWhatWasNotAdded) {
  LayerMeans means = empty_means();
  EXPECT_EQ(means.mean(1), std::vector<double>(3 * width * height, 0.0));
  add(means, 0, 3);
  for (Image& image : means.begin(pool())) {
    EXPECT_EQ(image.width, width);
    EXPECT_EQ(image.height, height);
    for (Rgb& p : image.pixels) {
      EXPECT_EQ(p, Rgb(0, 0, 0));
      p = Rgb(7, 7, 7);  // of an iteration that is then stopped
    }
  }
  add(means, 3, 5);
  LayerMeans straight = empty_means();
  add(straight, 0, 5);
  for (std::size_t k = 0; k < two_names.size(); ++k) EXPECT_EQ(means.mean(k), straight.mean(k));
}

TEST(LayerMeans, ComeBackFromBytesAndGoOnToTheSameBits) {
  LayerMeans straight = empty_means(), first = empty_means(), resumed = empty_means();
  add(straight, 0, 9);
  add(first, 0, 6);
  ByteWriter out;
  first.save(out);
  add(resumed, 0, 2);  // is gone
  ByteReader in(out.bytes());
  resumed.load(in, 6);
  EXPECT_TRUE(in.at_end());
  add(resumed, 6, 9);
  for (std::size_t k = 0; k < two_names.size(); ++k) EXPECT_EQ(resumed.mean(k), straight.mean(k));
  resumed.clear();
  add(resumed, 0, 9);
  EXPECT_EQ(resumed.mean(0), straight.mean(0));
}

TEST(LayerMeans, RefuseSavedOnesOfAnotherSizeOrThatAreNotFinite) {
  LayerMeans small({"a", "b"}, width, height - 1, no_memory_limit);
  ByteWriter of_small;
  small.save(of_small);
  ByteReader in(of_small.bytes());
  EXPECT_THROW(empty_means().load(in, 1), std::runtime_error);
  ByteWriter bad;
  for (int k = 0; k < 2; ++k) {
    std::vector<double> values(3 * width * height, 1.0);
    values[7] = k == 1 ? std::numeric_limits<double>::quiet_NaN() : 1;
    bad.put(values);
  }
  ByteReader of_bad(bad.bytes());
  EXPECT_THROW(empty_means().load(of_bad, 1), std::runtime_error);
}

TEST(LayerMeans, TakeNothingWhereNobodyAskedAndNoMoreThanAllowed) {
  LayerMeans none({}, 16384, 16384, 0);
  EXPECT_TRUE(none.begin(pool()).empty());
  none.add(pool());
  ByteWriter out;
  none.save(out);
  EXPECT_TRUE(out.bytes().empty());
  // A picture of 64 by 64 with 27 of them: a colour of 12 bytes, 24 of its sum, 12 in image.exr.
  const std::vector<std::string> names(27, "strategies.s0t2");
  constexpr std::uint64_t bytes = 27ULL * 64 * 64 * (12 + 24 + 12);
  EXPECT_NO_THROW(LayerMeans(names, 64, 64, bytes));
  try {
    const LayerMeans refused(names, 64, 64, bytes - 1);
    FAIL();
  } catch (const MemoryLimitError& e) {
    const std::string said = e.what();
    for (const char* part : {"27 images", "64 x 64", "strategies.s0t2", "5308416"}) {
      EXPECT_NE(said.find(part), std::string::npos) << said;
    }
  }
}

}  // namespace
}  // namespace lacuna
