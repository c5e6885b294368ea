#include "renderer/guides/tuning.h"

#include <gtest/gtest.h>

namespace lacuna {
namespace {

/// A guide of one cell whose choices take little off the moments of its vertices.
class TunedGuide {
 public:
  explicit TunedGuide(int pairs = 20000) : pairs_(pairs) {}
  explicit TunedGuide(Tuning::Directions directions) : TunedGuide() {
    tuning = Tuning({8}, AutoNumber{}, 1, directions);
  }

  /// An iteration in which each pixel has this variance.
  void iterate(double variance) {
    Tuning::Accumulator one = moments(1);
    for (int i = 0; i < pairs_; ++i) {
      const bool is_lit = i < iterations_lit * pairs_;
      one.noise.add(is_lit ? variance : 0, is_lit ? by_bsdf : 0);
    }
    if (bright > 0) one.noise.add(bright, bright_by_bsdf);
    update(one, 1);
  }
  /// The pilots that are due: pixels' variances with the guide and without, which guided paths
  /// tell, too. How many they are.
  int fly(double guided, double plain) {
    int n = 0;
    by_bsdf = plain;
    for (; n < 1000 && tuning.due_pilot(); ++n) {
      tuning.begin_pilot();
      const bool follows_bsdf = tuning.probability(0) == 0;
      Tuning::Accumulator one = moments(1.0 / 16);
      const double lit = follows_bsdf ? plain_lit : guided_lit;
      for (int i = 0; i < pairs_ / 16; ++i) {
        const bool is_lit = i < lit * pairs_ / 16;
        one.noise.add(is_lit ? (follows_bsdf ? plain : guided) : 0, is_lit ? plain : 0);
      }
      if (n == 0 && plain_bright > 0) one.noise.add(plain_bright, plain_bright);
      if (n == first_guided && bright > 0) one.noise.add(bright, bright_by_bsdf);
      update(one, 1.0 / 16);
    }
    return n;
  }
  static constexpr int first_guided = 3;
  bool rests() const { return !tuning.idle() && tuning.probability(0) == 0; }
  /// Iterates with the guide until it is to be compared; how often.
  int iterate_until_it_rests(double variance) {
    int n = 0;
    for (; n < 100 && !rests() && !tuning.idle(); ++n) iterate(variance);
    return n;
  }

  Tuning tuning{{8}, AutoNumber{}, 1};
  double by_bsdf = 0;                     // of guided pairs
  double plain_bright = 0;                // variance of one pair more, of the first of the pilots
  double bright = 0, bright_by_bsdf = 0;  // the same, of the first with the guide and of iterations
  double guided_lit = 1, plain_lit = 1;   // shares of the pairs that differ in pilots
  double iterations_lit = 1;              // and in iterations with the guide

 private:
  static Tuning::Accumulator moments(double iterations) {
    Tuning::Accumulator one;
    // Probabilities 0, 1/8, ...: with the guide .6 of the moment, so that it is chosen; then the
    // largest square and the number of paths.
    std::vector<double>& moments = one.moments[0];
    moments.assign(10, 1200.0);
    moments[0] = 2000;
    moments[8] = 10;
    moments[9] = 20000;
    for (double& m : moments) m *= iterations;
    moments[8] = 10;
    return one;
  }
  void update(const Tuning::Accumulator& one, double iterations) {
    const Tuning::Accumulator* const all[] = {&one};
    tuning.update(all, iterations);
    tuning.stop_if_useless();
  }

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
  EXPECT_EQ(guide.iterate_until_it_rests(100), 2) << "of one, too few paths";
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

TEST(Tuning, EndsBeforeTheFirstIterationWherePilotsHaveHardlyMoreNoiseWithoutIt) {
  TunedGuide guide;
  EXPECT_EQ(guide.fly(0.1, 0.13), 16);
  EXPECT_TRUE(guide.tuning.idle()) << "a guided iteration takes 1.75 times as long";
}

// Directions that are learned are expected to become better, until they should have.
TEST(Tuning, WaitsForDirectionsThatAreLearned) {
  TunedGuide guide(Tuning::Directions::learned);
  EXPECT_EQ(guide.fly(0.1, 0.13), 16);
  EXPECT_FALSE(guide.tuning.idle());
  int iterations = 0;
  for (; iterations < 512 && !guide.tuning.idle(); ++iterations) guide.iterate(0.1);
  EXPECT_EQ(iterations, 8) << "a gain of .3 less than it costs, .25 of which may come yet";
  TunedGuide poor(Tuning::Directions::learned);
  EXPECT_EQ(poor.fly(0.1, 0.1), 16);
  EXPECT_TRUE(poor.tuning.idle()) << ".4 would not make up for .56";
}

TEST(Tuning, GoesOnWherePilotsHaveMoreNoiseWithoutIt) {
  TunedGuide guide;
  EXPECT_EQ(guide.fly(0.1, 0.4), 16);
  EXPECT_FALSE(guide.tuning.idle());
  for (int i = 0; i < 40; ++i) {
    guide.iterate(0.1);
    ASSERT_GT(guide.tuning.probability(0), 0) << "iteration " << i;
    ASSERT_EQ(guide.fly(0.1, 0.4), 0) << "it is decided";
  }
}

TEST(Tuning, EndsWhereIterationsHaveMoreNoiseThanPilotsHad) {
  TunedGuide guide;
  guide.fly(0.1, 0.4);
  for (int i = 0; i < 8; ++i) guide.iterate(0.5);
  EXPECT_TRUE(guide.tuning.idle());
}

// One iteration with the guide would spoil what spread samples gain, however little noise it has.
TEST(Tuning, PilotsTellWhereLightIsSmooth) {
  for (const double largest_square : {0.5, 10.0}) {
    Tuning tuning({8}, AutoNumber{}, 1);
    while (tuning.due_pilot()) {
      tuning.begin_pilot();
      Tuning::Accumulator one;
      one.moments[0] = {125, 75, 75, 75, 75, 75, 75, 75, largest_square, 1250};
      for (int i = 0; i < 1250; ++i) one.noise.add(0.1, 0.4);
      const Tuning::Accumulator* const all[] = {&one};
      tuning.update(all, 1.0 / 16);
    }
    EXPECT_EQ(tuning.idle(), largest_square < 1);
  }
}

// Pilots that follow the BSDF meet few bright paths there, or none: guided paths tell of them.
TEST(Tuning, GoesOnWhereTheBsdfFindsNoLight) {
  for (const double one_path : {0.0, 2000.0}) {
    TunedGuide guide;
    guide.plain_bright = one_path;
    guide.plain_lit = 0;
    EXPECT_EQ(guide.fly(0.1, 0.5), 16);
    for (int i = 0; i < 200; ++i) {
      guide.iterate(0.1);
      ASSERT_GT(guide.tuning.probability(0), 0) << "iteration " << i;
      EXPECT_EQ(guide.fly(0.1, 0.5), 0);
    }
  }
}

// The last paths make both noises, and by turns tell that the guide does not pay and that it does.
TEST(Tuning, GoesOnWhereFewPathsTell) {
  TunedGuide guide;
  guide.plain_lit = 0;
  guide.bright = 1e6;
  guide.bright_by_bsdf = 1.3e6;
  int pilots = guide.fly(0.1, 0.3);
  EXPECT_EQ(pilots, 32);
  for (int i = 0; i < 200; ++i) {
    guide.bright *= 1.5;
    guide.bright_by_bsdf = (i % 2 == 0 ? 2.2 : 1.3) * guide.bright;
    guide.iterate(0.1);
    ASSERT_GT(guide.tuning.probability(0), 0) << "iteration " << i;
    const int later = guide.fly(0.1, 0.3);
    EXPECT_LE(later, 1);
    pilots += later;
  }
  EXPECT_EQ(pilots, 40) << "not for ever";
}

// One bright path of the guide makes most of both noises: their ratio is not known, whether that
// path tells the same as all others or not.
TEST(Tuning, DoesNotDecideByOnePathOfTheGuide) {
  for (const double bright : {0.0, 5000.0}) {
    for (const double ratio : {0.5, 1.0, 4.0}) {
      TunedGuide guide(Tuning::Directions::learned);
      guide.bright = bright;
      guide.bright_by_bsdf = bright * ratio;
      EXPECT_EQ(guide.fly(0.1, 0.1), bright > 0 ? 32 : 16);
      EXPECT_TRUE(guide.tuning.idle()) << "a gain has not been shown";
    }
  }
}

// One path of the BSDF tells nothing of a gain.
TEST(Tuning, EndsWherePilotsHaveShownNoGain) {
  TunedGuide guide;
  guide.plain_bright = 1e4;
  EXPECT_EQ(guide.fly(0.1, 0.1), 16);
  EXPECT_TRUE(guide.tuning.idle());
}

// The gain seems to be large, but the guide finds light less often than the BSDF, whose noise one
// path makes.
TEST(Tuning, EndsWherePilotsFindLessLight) {
  for (const double guided_lit : {0.3, 0.4, 0.8}) {
    TunedGuide guide;
    guide.plain_bright = 1e4;
    guide.plain_lit = 0.4;
    guide.guided_lit = guided_lit;
    guide.fly(0.1, 0.2);
    EXPECT_EQ(guide.tuning.idle(), guided_lit < 0.4) << guided_lit;
  }
}

/// After pilots that find light in `plain_lit` of the pairs with the BSDF, and so many times as
/// often with the guide; by few bright paths the guide halves the noise.
TunedGuide flown_by_few_paths(Tuning::Directions directions, double plain_lit, double ratio) {
  TunedGuide guide(directions);
  guide.plain_bright = 1e4;
  guide.plain_lit = plain_lit;
  guide.guided_lit = guide.iterations_lit = plain_lit * ratio;
  guide.fly(0.1, 0.2);
  return guide;
}

TEST(Tuning, EndsAfterThePilotsWhereFixedDirectionsFindLessLight) {
  EXPECT_TRUE(flown_by_few_paths(Tuning::Directions::fixed, 0.1, 0.7).tuning.idle());
  EXPECT_TRUE(flown_by_few_paths(Tuning::Directions::fixed, 0.4, 0.955).tuning.idle());
}

TEST(Tuning, WaitsForLearnedDirectionsToFindMoreLight) {
  for (const double plain_lit : {0.1, 0.4}) {
    TunedGuide guide = flown_by_few_paths(Tuning::Directions::learned, plain_lit, 0.7);
    const int waits = plain_lit < 0.25 ? 16 : 1;
    for (int i = 0; i < waits; ++i) {
      EXPECT_FALSE(guide.tuning.idle()) << plain_lit << ", iteration " << i;
      guide.iterate(0.1);
    }
    EXPECT_TRUE(guide.tuning.idle()) << plain_lit << ": they have not come to find more";
  }
}

TEST(Tuning, GoesOnWhereLearnedDirectionsFindHardlyLessLight) {
  TunedGuide guide = flown_by_few_paths(Tuning::Directions::learned, 0.4, 0.955);
  guide.iterate(0.1);
  EXPECT_FALSE(guide.tuning.idle());
}

/// Pilots by which both noises are the same.
TunedGuide flown(Tuning::Directions directions, double plain_lit, double guided_lit) {
  TunedGuide guide(directions);
  guide.plain_lit = plain_lit;
  guide.guided_lit = guided_lit;
  EXPECT_EQ(guide.fly(0.1, 0.1), 16);
  return guide;
}

// What is not known of the noise of dark pictures is known of how often light is found.
TEST(Tuning, GoesOnInTheDarkWherePilotsFindMoreLight) {
  using enum Tuning::Directions;
  EXPECT_TRUE(flown(fixed, 0.07, 2.2 * 0.07).tuning.idle()) << "may miss bright paths";
  EXPECT_FALSE(flown(fixed, 0.07, 4.2 * 0.07).tuning.idle());
  EXPECT_TRUE(flown(learned, 0.07, 0.07).tuning.idle());
  EXPECT_FALSE(flown(learned, 0.07, 1.5 * 0.07).tuning.idle()) << "it becomes better";
  EXPECT_TRUE(flown(learned, 0.3, 0.66).tuning.idle()) << "there the noise is known";
}

TEST(Tuning, IsJudgedByTheNoiseOfDarkPicturesLater) {
  TunedGuide guide = flown(Tuning::Directions::learned, 0.07, 0.3);
  for (int i = 0; i < 15; ++i) guide.iterate(0.1);
  EXPECT_FALSE(guide.tuning.idle());
  guide.iterate(0.1);
  EXPECT_TRUE(guide.tuning.idle());
}

// Few pixels are lit, and nearly in the ratio that guiding costs: all pilots are needed.
TEST(Tuning, PilotsDecideWhereTheRatioIsKnown) {
  for (const double plain : {0.16, 0.19}) {
    TunedGuide guide;
    guide.plain_lit = guide.guided_lit = 0.02;
    EXPECT_EQ(guide.fly(0.1, plain), 32);
    EXPECT_EQ(guide.tuning.idle(), plain < 0.175);
    EXPECT_FALSE(guide.tuning.due_pilot());
  }
}

TEST(Tuning, EndsWhenLaterPilotsKnowTheBsdf) {
  TunedGuide guide;
  guide.fly(0.1, 0);
  for (int i = 0; i < 40 && !guide.tuning.idle(); ++i) {
    guide.iterate(0.1);
    guide.fly(0.1, 0.1);
  }
  EXPECT_TRUE(guide.tuning.idle());
}

TEST(Tuning, SmallPicturesHaveOnePilot) {
  TunedGuide guide(100);
  EXPECT_EQ(guide.fly(100, 1e6), 1) << "of the first it is known that they are small";
  for (int i = 0; i < 8 && !guide.tuning.idle(); ++i) guide.iterate(100);
  EXPECT_TRUE(guide.tuning.idle()) << "moments promise little";
}

TEST(Tuning, HasNoPilotsWhereItsProbabilityIsGiven) {
  const Tuning tuning({2, 8}, AutoNumber{0.5}, 1);
  EXPECT_TRUE(tuning.learns());
  EXPECT_FALSE(tuning.due_pilot());
}

/// Where the BSDF finds light in this share of the pairs of pixels, after ten paths of which the
/// largest square was `largest`, of a moment of 1000 by the BSDF and of `step` more for each higher
/// probability of the guide.
double probability_after(double largest, double lit, double step = 100) {
  Tuning tuning({8}, AutoNumber{}, 1);
  Tuning::Accumulator one;
  std::vector<double>& moments = one.moments[0];
  for (int i = 0; i < 8; ++i) moments.push_back(1000 + step * i);
  moments.insert(moments.end(), {largest, 10});
  for (int i = 0; i < 1000; ++i) one.noise.add(i < 1000 * lit ? 1 : 0, 0);
  const Tuning::Accumulator* const all[] = {&one};
  for (int i = 0; i < 2; ++i) {
    tuning.begin_pilot();
    tuning.update(all, 1.0 / 16);
  }
  return double(tuning.probability(0));
}

TEST(Tuning, DoesNotDropTheGuideInTheDark) {
  EXPECT_EQ(probability_after(1, 0.9), 0);
  EXPECT_EQ(probability_after(1, 0.1), 0.5) << "of light not found yet nothing is known";
  EXPECT_EQ(probability_after(900, 0.9), 0);
  EXPECT_EQ(probability_after(900, 0.1), 0.5);
  EXPECT_EQ(probability_after(1, 0.1, -100), 0.875) << "at least half: more, where that is better";
}

// One more path like the largest, from a direction that the guide does not sample, has a square
// 1 / (1 - probability) times as large.
TEST(Tuning, ReckonsWithAPathThatTheGuideDoesNotSample) {
  for (const double largest : {0.01, 45.0}) {
    Tuning tuning({8}, AutoNumber{}, 1);
    Tuning::Accumulator one;
    one.moments[0] = {1000, 500, 400, 350, 330, 320, 310, 300, largest, 100};
    const Tuning::Accumulator* const all[] = {&one};
    tuning.update(all, 1);
    EXPECT_EQ(tuning.probability(0), largest < 1 ? 0.875F : 0.5F);
  }
}

TEST(Tuning, IsSavedBetweenPilots) {
  TunedGuide guide, loaded;
  guide.fly(0.1, 0);
  guide.iterate(0.1);
  ByteWriter out;
  guide.tuning.save(out);
  ByteReader in(out.bytes());
  loaded.tuning.load(in);
  EXPECT_TRUE(in.at_end());
  EXPECT_EQ(loaded.tuning.due_pilot(), guide.tuning.due_pilot());
  EXPECT_TRUE(loaded.tuning.due_pilot().has_value());
}

}  // namespace
}  // namespace lacuna
