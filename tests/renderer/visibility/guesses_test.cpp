// Probabilistic visibility with any guess has the mean of exact visibility, also with guesses that
// are wrong on purpose; and the learned rates are those of all lights.

#include "renderer/visibility/probabilistic_visibility.h"
#include "tests/renderer/visibility/mean_of_exact.h"

namespace lacuna {
namespace {

using test::expect_mean_of_exact;
using test::gathered;
using test::LitScene;

/// Guesses that are made up: `kind` says of what.
enum class Kind { all_visible, all_occluded, random, true_values, inverted, nothing };

struct MadeUp : VisibilityBase {
  explicit MadeUp(Kind of) : kind(of) {}
  struct At {
    ShadingPoint point;
    Rng rng;
  };
  Counters begin(const LightPass& pass) {
    terms = &pass.terms;
    rays = &pass.context.scene.rays();
    return {};
  }
  static At at(const ShadingPoint& p, const IterationContext& context) {
    return {p, Rng(context.seed, p.pixel, 0, Rng::Purpose::test)};
  }
  void decide(At& at, std::size_t block, const Terms& of, VisibilityEstimate& d) const {
    d.tests = kind == Kind::nothing ? of.lit : 0;
    d.untested.v.fill(kind == Kind::all_visible ? 1 : 0);
    if (kind == Kind::random) {
      for (float& q : d.untested.v) q = at.rng.next();
    } else if (kind == Kind::true_values || kind == Kind::inverted) {
      for_each_bit(of.lit, [&](int i) {
        const bool occluded = rays->occluded(terms->ray(at.point, block, i));
        d.untested[i] = occluded == (kind == Kind::inverted) ? 1.0F : 0.0F;
      });
    }
  }

  Kind kind;
  const VplContributions* terms = nullptr;
  const RayCaster* rays = nullptr;
};

ProbabilisticVisibilitySettings few_points() {
  ProbabilisticVisibilitySettings s;
  s.cache_points = s.variance_points = 40;
  return s;
}

ProbabilisticVisibility made_up(Kind kind, Reliability reliability) {
  std::vector<std::unique_ptr<GuessSource>> sources;
  sources.push_back(std::make_unique<GuessOf<MadeUp>>("made_up", kind));
  ProbabilisticVisibilitySettings s = few_points();
  s.reliability = reliability;
  return {s, std::move(sources)};
}

/// Learns from the tests of some iterations with the same lights; returns the tests of a round.
double learn(const LitScene& lit, ProbabilisticVisibility& visibility, int rounds = 20) {
  std::uint64_t tests = 0;
  lit.with_points(400, [&](std::span<const ShadingPoint> points) {
    for (int r = 0; r < rounds; ++r) {
      tests = 0;
      gathered(lit, lit.context(1000 + static_cast<std::uint64_t>(r)), visibility, points, &tests);
      visibility.end();
    }
  });
  return double(tests);
}

class Guesses : public testing::TestWithParam<test::PathScene> {};

TEST_P(Guesses, HaveTheMeanOfExact) {
  ViewMapsVisibilitySettings view_maps;
  view_maps.map_size = 8, view_maps.levels = 5;
  NodeMapsVisibilitySettings node_maps;
  node_maps.map_size = 16;
  const std::vector<GuessSettings> guesses{
      CachePointsGuessSettings{},
      view_maps,
      node_maps,
      GatesVisibilitySettings{},
      CellsGuessSettings{},
      MixtureGuessSettings{{view_maps, node_maps, GatesVisibilitySettings{}}},
      MixtureGuessSettings{{CachePointsGuessSettings{}, CellsGuessSettings{}}}};
  LitScene lit(GetParam(), 60, 2);
  for (std::size_t i = 0; i < guesses.size(); ++i) {
    SCOPED_TRACE(i);
    ProbabilisticVisibilitySettings s = few_points();
    s.guess = guesses[i];
    s.reliability = Reliability::clusters;
    ProbabilisticVisibility visibility(s);
    lit.prepare(visibility);
    learn(lit, visibility, 5);
    lit.with_points(400, [&](std::span<const ShadingPoint> points) {
      ASSERT_GT(points.size(), 5U);
      expect_mean_of_exact(lit, visibility, points, false, 200);
    });
  }
}

INSTANTIATE_TEST_SUITE_P(All, Guesses,
                         testing::Values(test::PathScene{"ajar"}, test::PathScene{"open", true}),
                         [](const auto& s) { return s.param.name; });

TEST(Guesses, ThatAreWrongHaveTheMeanOfExact) {
  LitScene lit({"ajar"}, 60, 2);
  for (const Reliability reliability : {Reliability::assumed, Reliability::picture}) {
    for (const Kind kind :
         {Kind::all_visible, Kind::all_occluded, Kind::random, Kind::inverted, Kind::nothing}) {
      SCOPED_TRACE(static_cast<int>(kind));
      ProbabilisticVisibility visibility = made_up(kind, reliability);
      lit.prepare(visibility);
      learn(lit, visibility, 3);
      lit.with_points(400, [&](std::span<const ShadingPoint> points) {
        expect_mean_of_exact(lit, visibility, points, false, 200);
      });
    }
  }
}

// The rates of a guess that is always wrong say as much as those of one that is always right.
TEST(GuessReliability, KnowsThatAnInvertedGuessIsReliable) {
  LitScene lit({"ajar"}, 60, 2);
  ProbabilisticVisibility right = made_up(Kind::true_values, Reliability::picture);
  ProbabilisticVisibility inverted = made_up(Kind::inverted, Reliability::picture);
  ProbabilisticVisibility random = made_up(Kind::random, Reliability::picture);
  lit.prepare(right);
  lit.prepare(inverted);
  lit.prepare(random);
  const double tests = learn(lit, right), of_inverted = learn(lit, inverted);
  EXPECT_NEAR(of_inverted, tests, 0.05 * tests);
  EXPECT_GT(learn(lit, random), 1.5 * tests);
  const auto stats = inverted.statistics();
  EXPECT_EQ(stats[1], std::pair(std::string("made_up_wrong_if_occluded"), 1.0));
  EXPECT_EQ(stats[2], std::pair(std::string("made_up_wrong_if_visible"), 1.0));
}

// Bright lights, which are visible more often than others, are tested more often.
TEST(GuessReliability, IsThatOfAllLights) {
  LitScene lit({"ajar"}, 300, 2);
  ProbabilisticVisibility visibility = made_up(Kind::all_visible, Reliability::picture);
  lit.prepare(visibility);
  double lights = 0, visible = 0;
  statistics::Moments rate;
  lit.with_points(400, [&](std::span<const ShadingPoint> points) {
    Terms terms;
    for (const ShadingPoint& p : points) {
      for (std::size_t b = 0; b < lit.lights().blocks(p.edges); ++b) {
        lit.terms().evaluate(p, b, terms);
        for_each_bit(terms.lit, [&](int i) {
          ++lights;
          visible += lit.scene().rays().occluded(lit.terms().ray(p, b, i)) ? 0 : 1;
        });
      }
    }
    for (std::uint64_t r = 0; r < 60; ++r) {
      ProbabilisticVisibility fresh = made_up(Kind::all_visible, Reliability::picture);
      const IterationContext context = lit.context(r + 2);
      fresh.begin(lit.pass(context));
      gathered(lit, context, fresh, points);
      fresh.end();
      rate.add(1 - fresh.statistics()[2].second);
    }
  });
  EXPECT_GT(statistics::t_test(rate, visible / lights), 1e-4)
      << rate.mean() << " +- " << rate.standard_error() << ", not " << visible / lights;
  EXPECT_LT(rate.standard_error(), 0.02);
}

TEST(GuessReliability, CombinesCellsWithTheRestAndResumes) {
  using Tally = GuessReliability::Tally;
  GuessReliability r;
  r.resize(3, 4);
  EXPECT_EQ(r.rates(0), nullptr);
  const std::uint64_t one = GuessReliability::one;
  r.add(1, std::vector<Tally>{{8, 8 * one, 6 * one}});
  r.add(2, std::vector<Tally>{{2, 20 * one, 0}});
  EXPECT_EQ(r.rates(0), nullptr) << "before the end of the iteration";
  r.discard();
  r.add(1, std::vector<Tally>{{8, 8 * one, 6 * one}});
  r.add(2, std::vector<Tally>{{2, 20 * one, 0}});
  r.update();
  const double all = (10 * 6.0 / 28 + 2 * 0.5) / 12;
  EXPECT_FLOAT_EQ(r.rates(0)[0], float(all));
  EXPECT_FLOAT_EQ(r.rates(1)[0], float((8 * 0.75 + 2 * all) / 10));
  EXPECT_FLOAT_EQ(r.rates(2)[0], float(2 * all / 4));
  EXPECT_EQ(r.rates(0)[3], 0.5F) << "never answered";
  ByteWriter out;
  r.save(out);
  GuessReliability again;
  again.resize(3, 4);
  ByteReader in(out.bytes());
  again.load(in);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(again.rates(0)[i], r.rates(0)[i]);
  again.resize(2, 4);
  ByteReader other(out.bytes());
  EXPECT_THROW(again.load(other), std::runtime_error);
}

TEST(GuessAnswers, AreDigits) {
  VisibilityEstimate d;
  d.untested[0] = 0, d.untested[1] = 0.5F, d.untested[2] = 1, d.untested[3] = 0;
  d.tests = 8;
  GuessAnswers answers;
  answers.append(d);
  d.tests = 0;
  answers.append(d);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(GuessAnswers::answer(answers[i], 0, 2), i);
    EXPECT_EQ(GuessAnswers::answer(answers[i], 1, 2), i % 3);
  }
}

}  // namespace
}  // namespace lacuna
