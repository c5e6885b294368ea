#include "renderer/guides/tuning.h"

#include <gtest/gtest.h>

namespace lacuna {
namespace {

/// A guide of one cell whose choices take little off the moments of its vertices.
class TunedGuide {
 public:
  explicit TunedGuide(int pairs = 20000) : pairs_(pairs) {}

  /// An iteration in which each pixel has this variance.
  void iterate(double variance) {
    Tuning::Accumulator one;
    // Probabilities 0, 1/8, ...: with the guide .6 of the moment, so that it is chosen; then the
    // largest square and the number of paths.
    std::vector<double>& moments = one.moments[0];
    moments.assign(10, 1200.0);
    moments[0] = 2000;
    moments[8] = 10;
    moments[9] = 20000;
    for (int i = 0; i < pairs_; ++i) one.noise.add(variance);
    const Tuning::Accumulator* const all[] = {&one};
    tuning.update(all);
    tuning.stop_if_useless();
  }
  bool rests() const { return !tuning.idle() && tuning.probability(0) == 0; }
  /// Iterates with the guide until it is to be compared; how often.
  int iterate_until_it_rests(double variance) {
    int n = 0;
    for (; n < 100 && !rests() && !tuning.idle(); ++n) iterate(variance);
    return n;
  }

  Tuning tuning{{8}, AutoNumber{}, 1};

 private:
  int pairs_;
};

TEST(Tuning, GoesOnWhereIterationsWithoutTheGuideHaveMoreNoise) {
  TunedGuide guide;
  EXPECT_LT(guide.iterate_until_it_rests(0.1), 10);
  ASSERT_TRUE(guide.rests());
  guide.iterate(0.3);
  EXPECT_FALSE(guide.tuning.idle());
  EXPECT_GT(guide.tuning.probability(0), 0);
  // Decided anew after twice as many paths, and not before.
  EXPECT_GT(guide.iterate_until_it_rests(0.1), 2);
}

TEST(Tuning, EndsWhereTheyHaveHardlyMore) {
  TunedGuide guide;
  guide.iterate_until_it_rests(0.1);
  guide.iterate(0.13);
  EXPECT_TRUE(guide.tuning.idle()) << "a guided iteration takes 1.75 times as long";
  EXPECT_EQ(guide.tuning.probability(0), 0);
}

TEST(Tuning, ComparesRarely) {
  TunedGuide guide;
  int rests = 0;
  for (int i = 0; i < 320; ++i) {
    const bool resting = guide.rests();
    rests += resting ? 1 : 0;
    guide.iterate(resting ? 0.3 : 0.1);
  }
  EXPECT_GE(rests, 2);
  EXPECT_LE(rests, 320 / 16);
}

TEST(Tuning, EndsWithoutComparisonWhereNothingIsPromised) {
  TunedGuide guide;
  guide.iterate(1);
  EXPECT_TRUE(guide.tuning.idle());
}

TEST(Tuning, JudgesSmallPicturesByMoments) {
  TunedGuide guide(100);
  EXPECT_EQ(guide.iterate_until_it_rests(100), 1);
  EXPECT_TRUE(guide.tuning.idle()) << "moments promise little";
}

TEST(Tuning, IsSavedWhileItRests) {
  TunedGuide guide, loaded;
  guide.iterate_until_it_rests(0.1);
  ByteWriter out;
  guide.tuning.save(out);
  ByteReader in(out.bytes());
  loaded.tuning.load(in);
  EXPECT_TRUE(in.at_end());
  EXPECT_TRUE(loaded.rests());
  loaded.iterate(0.13);
  EXPECT_TRUE(loaded.tuning.idle());
}

}  // namespace
}  // namespace lacuna
