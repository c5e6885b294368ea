#include "renderer/film/film.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "base/storage/bytes.h"
#include "renderer/core/rng.h"
#include "renderer/film/block_statistics.h"
#include "renderer/film/half_layers.h"
#include "renderer/film/metrics.h"
#include "renderer/images/exr_write.h"
#include "renderer/images/image_read.h"
#include "tests/renderer/gltf/glb_builder.h"

namespace lacuna {
namespace {

/// `n` iterations of noise about `level`, and all values for a plain evaluation.
Film noisy(int n, float level, std::vector<std::vector<double>>* values = nullptr) {
  Film film(5, 4);
  for (int i = 0; i < n; ++i) {
    Rng rng(1, static_cast<std::uint64_t>(i), 0, Rng::Purpose::test);
    Image image(5, 4);
    std::vector<double> flat;
    for (Rgb& p : image.pixels) {
      p = Rgb(level + rng.next(), level - rng.next(), level * rng.next());
      for (const float v : {p.x, p.y, p.z}) flat.push_back(double(v));
    }
    if (values != nullptr) values->push_back(flat);
    film.add(static_cast<std::uint64_t>(i), image);
  }
  return film;
}

TEST(Film, MeanAndVarianceAreTheTextbookOnes) {
  for (const int n : {2, 3, 17}) {
    std::vector<std::vector<double>> values;
    const Film film = noisy(n, 1000, &values);
    const std::vector<double> mean = film.mean();
    const std::vector<double> variance = film.variance_of_mean();
    for (std::size_t k = 0; k < mean.size(); ++k) {
      double m = 0;
      for (const auto& v : values) m += v[k] / n;
      double s2 = 0;
      for (const auto& v : values) s2 += (v[k] - m) * (v[k] - m) / (n - 1);
      EXPECT_NEAR(mean[k], m, 1e-9 * std::abs(m));
      EXPECT_NEAR(variance[k], s2 / n, 1e-9 * s2);
    }
  }
}

TEST(Film, SquaredErrorsHaveTheVarianceAsTheirMean) {
  constexpr int n = 400;
  const Film film = noisy(n, 1);
  // 5 x 4 pixels: 16 pictures, four of them of two pixels; n - 2 iterations have a mean before
  // them.
  EXPECT_EQ(film.squared_errors().count(), 16U * (n - 2));
  const std::vector<double> largest = film.squared_errors().largest();
  EXPECT_EQ(largest.size(), SquaredErrors::kept);
  EXPECT_TRUE(std::is_sorted(largest.begin(), largest.end()));

  const Film few = noisy(200, 1);
  const std::vector<double> all = few.squared_errors().largest();
  ASSERT_EQ(all.size(), few.squared_errors().count());
  double mean = 0, squares = 0;
  for (const double v : all) {
    mean += v / double(all.size());
    squares += v * v / double(all.size());
  }
  // Each channel is uniform: variance 1/12.
  const double error = std::sqrt((squares - mean * mean) / double(all.size()));
  EXPECT_NEAR(mean, 1.0 / 12, 4 * error);
  EXPECT_LT(error, 0.01 * mean);
}

TEST(Film, SquaredErrorsAreKeptInACheckpoint) {
  const Film film = noisy(50, 1);
  ByteWriter out;
  film.save(out);
  const std::string bytes = out.bytes();
  Film copy(5, 4);
  ByteReader in(bytes);
  copy.load(in);
  EXPECT_TRUE(in.at_end());
  EXPECT_EQ(copy.squared_errors().count(), film.squared_errors().count());
  EXPECT_EQ(copy.squared_errors().largest(), film.squared_errors().largest());
}

TEST(Film, HalvesAreEvenAndOddIterations) {
  std::vector<std::vector<double>> values;
  const Film film = noisy(5, 1, &values);
  EXPECT_EQ(film.half_iterations(0), 3U);
  EXPECT_EQ(film.half_iterations(1), 2U);
  for (std::size_t k = 0; k < values[0].size(); ++k) {
    EXPECT_NEAR(film.half_mean(1)[k], (values[1][k] + values[3][k]) / 2, 1e-12);
  }
}

TEST(Film, ComesBackFromBytesAndGoesOnTheSame) {
  Film straight = noisy(9, 3);
  ByteWriter out;
  noisy(6, 3).save(out);
  Film resumed(5, 4);
  ByteReader in(out.bytes());
  resumed.load(in);
  EXPECT_TRUE(in.at_end());
  for (int i = 6; i < 9; ++i) {
    Rng rng(1, static_cast<std::uint64_t>(i), 0, Rng::Purpose::test);
    Image image(5, 4);
    for (Rgb& p : image.pixels) p = Rgb(3 + rng.next(), 3 - rng.next(), 3 * rng.next());
    resumed.add(static_cast<std::uint64_t>(i), image);
  }
  EXPECT_EQ(resumed.mean(), straight.mean());
  EXPECT_EQ(resumed.variance_of_mean(), straight.variance_of_mean());
}

TEST(Film, RefusesBytesOfAnotherSizeAndShortOnes) {
  ByteWriter out;
  noisy(2, 1).save(out);
  Film other(4, 5);
  ByteReader in(out.bytes());
  EXPECT_THROW(other.load(in), std::runtime_error);
  for (std::size_t n = 0; n < out.bytes().size(); n += 37) {
    Film film(5, 4);
    ByteReader cut(std::string_view(out.bytes()).substr(0, n));
    EXPECT_THROW(film.load(cut), std::runtime_error);
  }
}

TEST(Film, RefusesSavedValuesThatAreNotFinite) {
  ByteWriter out;
  noisy(2, 1).save(out);
  std::string bytes = out.take();
  const double infinite = std::numeric_limits<double>::infinity();
  std::memcpy(bytes.data() + bytes.size() - sizeof infinite, &infinite, sizeof infinite);
  Film film(5, 4);
  ByteReader in(bytes);
  EXPECT_THROW(film.load(in), std::runtime_error);
}

TEST(Metrics, ByHand) {
  const std::vector<double> x{1, 2, -1};
  const std::vector<double> r{1, 1, 0};
  const Errors e = errors(x, r);
  EXPECT_DOUBLE_EQ(e[ErrorMetric::mae], 2.0 / 3);
  EXPECT_DOUBLE_EQ(e[ErrorMetric::mse], 2.0 / 3);
  EXPECT_DOUBLE_EQ(e[ErrorMetric::rmse], std::sqrt(2.0 / 3));
  EXPECT_DOUBLE_EQ(e[ErrorMetric::relmse], (1 / 1.01 + 1 / 0.01) / 3);
  EXPECT_DOUBLE_EQ(e[ErrorMetric::smape], (1 / 1.51 + 1 / 0.51) / 3);
  EXPECT_THROW(e[ErrorMetric::est_rmse], std::invalid_argument);
  EXPECT_THROW(errors(x, std::vector<double>{1}), std::invalid_argument);
  const std::vector<double> nan{1, std::nan(""), 0};
  EXPECT_TRUE(std::isnan(errors(nan, r)[ErrorMetric::mse]));
}

TEST(Metrics, HalvesPredictTheError) {
  // The truth is known: (level + 1/2, level - 1/2, level / 2). Averaged over many films the
  // estimate of the mse must agree with the mse itself, for odd and even numbers of iterations.
  for (const int n : {2, 7}) {
    double measured = 0;
    double predicted = 0;
    constexpr int films = 400;
    for (int f = 0; f < films; ++f) {
      Film film(5, 4);
      for (int i = 0; i < n; ++i) {
        Rng rng(static_cast<std::uint64_t>(f), static_cast<std::uint64_t>(i), 9,
                Rng::Purpose::test);
        Image image(5, 4);
        for (Rgb& p : image.pixels) p = Rgb(rng.next(), rng.next(), rng.next());
        film.add(static_cast<std::uint64_t>(i), image);
      }
      measured += errors(film.mean(), std::vector<double>(60, 0.5))[ErrorMetric::mse];
      const double rmse = estimated_rmse(film).value();
      predicted += rmse * rmse;
    }
    // Each is a mean of 24,000 squares: deviation sqrt(2 / 24000) = 0.9 %.
    EXPECT_NEAR(predicted / measured, 1, 0.05) << n;
  }
  Film one(5, 4);
  EXPECT_FALSE(estimated_rmse(one));
}

TEST(BlockStatistics, NoiseLooksLikeNoiseAndADifferenceDoesNot) {
  constexpr int side = 64;
  std::vector<double> a(3 * side * side), b(a.size()), variance(a.size(), 1.0 / 12);
  Rng rng(4, 0, 0, Rng::Purpose::test);
  for (std::size_t i = 0; i < a.size(); ++i) {
    a[i] = 1 + double(rng.next());
    b[i] = 1.5;
  }
  const BlockStatistics noise = block_statistics({a, b, variance, side, side}, 4);
  EXPECT_EQ(noise.blocks, 256);
  EXPECT_NEAR(noise.z_mean, 0, 4 / std::sqrt(768.0));
  EXPECT_NEAR(noise.z_deviation, 1, 4 / std::sqrt(2 * 768.0));
  const double of_block = 1.0 / 12 / 16;  // variance of a block's mean
  EXPECT_NEAR(noise.rms * noise.rms / of_block, 1, 4 * std::sqrt(2 / 768.0));
  for (double& v : a) v += 0.2;
  const BlockStatistics biased = block_statistics({a, b, variance, side, side}, 4);
  EXPECT_NEAR(biased.z_mean, 0.2 * 4 * std::sqrt(12.0), 0.2);
  EXPECT_GT(biased.largest_relative, 0.1);
  EXPECT_NEAR(biased.rms * biased.rms, 0.04 + of_block, 0.004);
}

TEST(Exr, LayersAndAttributesComeBack) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.exr";
  const std::vector<double> picture{0, 1, 2, 3, 4, 5, 1e30, -7, 8, 9, 10, 11};
  const std::vector<ExrLayer> layers{{"", {"R", "G", "B"}, picture},
                                     {"depth", {"Z"}, {1, 2, 3, 4}},
                                     {"even", {"R", "G", "B"}, std::vector<double>(12, 0.5)}};
  write_exr(file, {2, 2, layers, PixelType::single_float, {{"seed", "18446744073709551615"}}});
  const FloatImage back = read_float_image(file);
  ASSERT_EQ(back.rgb.size(), 12U);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(back.rgb[i], static_cast<float>(picture[i]));
  EXPECT_EQ(back.attributes.at("lacuna:seed"), "18446744073709551615");
  EXPECT_EQ(read_float_image(file, "even").rgb[0], 0.5F);
  // The same picture is the same file.
  const auto again = folder.path() / "b.exr";
  write_exr(again, {2, 2, layers, PixelType::single_float, {{"seed", "18446744073709551615"}}});
  std::ifstream f(file, std::ios::binary);
  std::ifstream g(again, std::ios::binary);
  EXPECT_TRUE(
      std::equal(std::istreambuf_iterator<char>(f), {}, std::istreambuf_iterator<char>(g), {}));
}

TEST(HalfLayers, KeepElevenBitsOfEveryLayer) {
  const std::vector<ExrLayer> layers{
      {"", {"R", "G", "B"}, {0, 1e30, 3.14159e25, -7e29, 5e29, 1e22}},
      {"depth", {"Z"}, {1e-20, 3e-21}},
      {"black", {"Z"}, {0, 0}}};
  ByteWriter packed;
  const std::vector<HalfLayer> index = pack_half(layers, packed);
  ASSERT_EQ(index.size(), layers.size());
  std::size_t offset = 0;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const HalfLayer& l = index[i];
    EXPECT_EQ(l.name, layers[i].name);
    EXPECT_EQ(l.channels, layers[i].channels);
    EXPECT_EQ(l.offset, offset);
    ASSERT_EQ(l.bytes, 2 * layers[i].values.size());
    offset += l.bytes;
    for (std::size_t k = 0; k < layers[i].values.size(); ++k) {
      const auto byte = [&](std::size_t b) {
        return static_cast<unsigned>(
            static_cast<unsigned char>(packed.bytes()[l.offset + 2 * k + b]));
      };
      half h;
      h.setBits(static_cast<std::uint16_t>(byte(0) | byte(1) << 8));
      const double v = layers[i].values[k];
      EXPECT_NEAR(static_cast<float>(h) * l.scale, v, 0x1p-11 * std::abs(v)) << l.name << " " << k;
    }
  }
  EXPECT_EQ(packed.bytes().size(), offset);
}

TEST(Exr, HalfRefusesWhatOverflowsAndLeavesTheOldFile) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.exr";
  write_exr(file, {1, 1, {{"", {"R", "G", "B"}, {1, 2, 3}}}, PixelType::half_float, {}});
  EXPECT_THROW(
      write_exr(file, {1, 1, {{"", {"R", "G", "B"}, {1, 70000, 3}}}, PixelType::half_float, {}}),
      std::runtime_error);
  EXPECT_EQ(read_float_image(file).rgb[1], 2);
}

}  // namespace
}  // namespace lacuna
