#include "renderer/mutations/primary_samples.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "jobs/sweep/distributions.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

constexpr int bins = 16;

std::uint32_t first_word(PrimarySamples& samples) { return Rng(samples).next_u32(); }
std::size_t bin(std::uint32_t word) { return word / (std::uint32_t{1} << 28); }

/// Counts of moves between parts of the unit interval, by small steps from uniform points.
std::array<std::array<double, bins>, bins> moves(double distance, int n) {
  std::array<std::array<double, bins>, bins> counts{};
  Rng rng(3, 0, 0, Rng::Purpose::test);
  for (int i = 0; i < n; ++i) {
    PrimarySamples samples;
    samples.propose_fresh(rng);
    const std::size_t from = bin(first_word(samples));
    samples.accept();
    samples.propose_near(rng, distance);
    ++counts[from][bin(first_word(samples))];
  }
  return counts;
}

// With a constant target every proposal is accepted: the chain must stay uniform, and go from any
// part to any other as often as back.
TEST(PrimarySamples, SmallStepsAreInDetailedBalance) {
  for (const double distance : {0.03, 0.3}) {
    const auto counts = moves(distance, 100000);
    double uniform = 0, balance = 0;
    int pairs = 0;
    for (std::size_t i = 0; i < bins; ++i) {
      double arrived = 0;
      for (std::size_t j = 0; j < bins; ++j) {
        arrived += counts[j][i];
        if (j >= i || counts[i][j] + counts[j][i] < 10) continue;
        balance += std::pow(counts[i][j] - counts[j][i], 2) / (counts[i][j] + counts[j][i]);
        ++pairs;
      }
      uniform += std::pow(arrived - 100000.0 / bins, 2) / (100000.0 / bins);
    }
    EXPECT_GT(chi_square_beyond(uniform, bins - 1), 1e-4) << distance;
    EXPECT_GT(chi_square_beyond(balance, pairs), 1e-4) << distance;
    EXPECT_GE(pairs, bins) << "the torus has neighbours across its end";
  }
}

TEST(PrimarySamples, MoveByNoMoreThanTheDistance) {
  Rng rng(3, 0, 0, Rng::Purpose::test);
  PrimarySamples samples;
  samples.propose_fresh(rng);
  const std::uint32_t start = first_word(samples);
  samples.accept();
  statistics::Moments moved;
  for (int i = 0; i < 10000; ++i) {
    samples.propose_near(rng, 0.01);
    const auto by = static_cast<std::int32_t>(first_word(samples) - start);
    ASSERT_LE(std::abs(double(by)), 0.01 * 0x1p32);
    moved.add(std::abs(double(by)) * 0x1p-32);
  }
  EXPECT_LT(std::abs(statistics::z_test(moved, 0.005)), 4);
}

TEST(PrimarySamples, AreKeptOnlyWhenAccepted) {
  Rng rng(3, 0, 0, Rng::Purpose::test);
  PrimarySamples samples;
  samples.propose_fresh(rng);
  const std::uint32_t first = first_word(samples);
  samples.accept();
  samples.propose_near(rng, 0.1);
  const std::uint32_t second = first_word(samples);
  EXPECT_NE(second, first);
  samples.propose_near(rng, 0);
  EXPECT_EQ(first_word(samples), first) << "the proposal before was not accepted";
  samples.propose_near(rng, 0.1);
  const std::uint32_t third = first_word(samples);
  samples.accept();
  samples.propose_near(rng, 0);
  EXPECT_EQ(first_word(samples), third);
}

TEST(PrimarySamples, BeyondWhatWasReadAreNew) {
  Rng rng(3, 0, 0, Rng::Purpose::test);
  PrimarySamples samples;
  samples.propose_fresh(rng);
  first_word(samples);
  samples.accept();
  const auto second_vertex = [&] {
    samples.propose_near(rng, 0);
    Rng stream(samples);
    stream.next_u32();
    stream.next_vertex();
    return stream.next_u32();
  };
  const std::uint32_t a = second_vertex();
  EXPECT_NE(second_vertex(), a);
  samples.accept();
  const std::uint32_t kept = second_vertex();
  EXPECT_EQ(second_vertex(), kept);
}

// What is read at one vertex does not move what the next one reads.
TEST(PrimarySamples, EachVertexBeginsABlock) {
  Rng rng(3, 0, 0, Rng::Purpose::test);
  PrimarySamples samples;
  samples.propose_fresh(rng);
  const auto at_second = [&](int read_at_first) {
    Rng stream(samples);
    for (int i = 0; i < read_at_first; ++i) stream.next_u32();
    stream.next_vertex();
    return stream.next_u32();
  };
  const std::uint32_t word = at_second(3);
  samples.accept();
  samples.propose_near(rng, 0);
  EXPECT_EQ(at_second(5), word);
}

}  // namespace
}  // namespace lacuna
