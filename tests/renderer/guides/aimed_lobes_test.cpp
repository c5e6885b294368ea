// Lobes that are fitted to light, seen from places around it.

#include "renderer/guides/aimed_lobes.h"

#include <gtest/gtest.h>

#include "renderer/guides/direction_tree.h"
#include "tests/renderer/guides/density_check.h"

namespace lacuna {
namespace {

constexpr float uniform_density = 1 / (4 * pi);

/// Light of this weight that arrives at `x` from a point at this distance along `w`.
TrainingSample arriving(const V3f& x, const V3f& w, float distance, float weight) {
  return {.cell = {1, 0},
          .x = x,
          .n = {0, 0, 1},
          .w = w,
          .distance = distance,
          .cosine = 1,
          .pdf = 1,
          .radiance = weight};
}

V3f direction(Rng& rng) { return from_square(rng.next2()); }

/// A place in the cube of half-width `r` around the origin.
V3f place(Rng& rng, float r) {
  const V2f u = rng.next2();
  return (V3f(u.x, u.y, rng.next()) * 2.0F - V3f(1.0F)) * r;
}

using Light = std::function<float(const V3f&)>;

/// Learned in four rounds from as many uniform directions each; a black one is not light.
AimedLobes lobes_of(const Light& light, int samples) {
  AimedLobes lobes;
  for (std::uint64_t round = 0; round < 4; ++round) {
    Rng rng(41, round, 0, Rng::Purpose::test);
    std::vector<TrainingSample> batch;
    for (int i = 0; i < samples; ++i) {
      const V3f w = direction(rng);
      if (light(w) > 0)
        batch.push_back(arriving({0, 0, 0}, w, HUGE_VALF, light(w) / uniform_density));
    }
    lobes.learn(batch);
    lobes.next_round();
  }
  return lobes;
}

/// Light from `target`, found at so many `places` around the origin.
AimedLobes aimed(const V3f& target, bool distances, int places) {
  Rng rng(42, 0, 0, Rng::Purpose::test);
  AimedLobes lobes;
  for (int round = 0; round < 3; ++round) {
    std::vector<TrainingSample> batch;
    for (int i = 0; i < places; ++i) {
      const V3f x = place(rng, 0.5F), d = target - x;
      batch.push_back(arriving(x, d.normalized(), distances ? d.length() : HUGE_VALF, 1));
    }
    lobes.learn(batch);
    lobes.next_round();
  }
  return lobes;
}

TEST(AimedLobes, DrawWithTheirDensity) {
  const V3f target(0.5F, 1.5F, 1);
  const AimedLobes wide =
      lobes_of([](const V3f& w) { return w.x > 0.7F ? 9.0F
                                         : w.z > 0  ? 1.0F
                                                    : 0.1F; }, 2000);
  const AimedLobes narrow = aimed(target, true, 4000), blurred = aimed(target, false, 300);
  const std::array<V3f, 4> places{V3f(0, 0, 0), V3f(0.4F, 0.3F, -0.4F), V3f(-3, 2, 7),
                                  V3f(0.48F, 1.4F, 0.95F)};
  const double level = statistics::sidak(1e-3, 3 * places.size());
  for (const AimedLobes* lobes : {&wide, &narrow, &blurred}) {
    for (const V3f& x : places) {
      Rng rng(43, 0, 0, Rng::Purpose::test);
      const auto draw = [&] { return lobes->sample(x, rng.next_fine_point()); };
      const auto c = test::density_check(
          draw, [&](const V3f& w) { return lobes->pdf(x, w).value; }, 40000, rng,
          (target - x).normalized(), 24);
      EXPECT_GT(c.p, level) << x;
      EXPECT_NEAR(c.integral, 1, 5 * c.integral_error + 1e-4);
      EXPECT_EQ(c.failed, 0);
    }
  }
}

// The information that is lost, in nats (Kullback and Leibler 1951), beside that of no knowledge.
TEST(AimedLobes, FitTheLight) {
  const V3f a(0.6F, 0, 0.8F), b(0, -1, 0);
  const Light light = [&](const V3f& w) {
    return 8 * std::exp(60 * (dot(a, w) - 1)) + 3 * std::exp(8 * (dot(b, w) - 1)) + 0.02F;
  };
  const AimedLobes lobes = lobes_of(light, 20000);
  Rng rng(44, 0, 0, Rng::Purpose::test);
  double all = 0;
  std::vector<std::pair<V3f, double>> samples;
  for (int i = 0; i < 400000; ++i) {
    const V3f w = direction(rng);
    samples.emplace_back(w, double(light(w)));
    all += samples.back().second;
  }
  double lost = 0, unknown = 0;
  for (const auto& [w, l] : samples) {
    const double density = l / all * double(samples.size()) * double(uniform_density);
    unknown += l / all * std::log(density / double(uniform_density));
    lost += l / all * std::log(density / double(lobes.pdf({0, 0, 0}, w).value));
  }
  EXPECT_LT(lost, 0.03);
  EXPECT_GT(unknown, 30 * 0.03) << "the test has no power";
  EXPECT_GT(lost, -0.01);
}

TEST(AimedLobes, FollowThePlace) {
  const V3f target(0.5F, 1.5F, 1);
  const AimedLobes near = aimed(target, true, 2000), far = aimed(target, false, 2000);
  Rng rng(45, 0, 0, Rng::Purpose::test);
  statistics::Moments gain;
  for (int i = 0; i < 1000; ++i) {
    const V3f x = place(rng, 0.5F), w = (target - x).normalized();
    gain.add(std::log(double(near.pdf(x, w) / far.pdf(x, w))));
  }
  EXPECT_GT(gain.mean() - 5 * gain.standard_error(), std::log(10.0));
}

// What was learned from one place is seen from another one later: the parts of a cell that was
// divided begin with its lobes.
TEST(AimedLobes, AreTheSameSeenFromElsewhere) {
  const V3f target(0.5F, 1.5F, 1);
  AimedLobes lobes = aimed(target, true, 100);
  std::vector<TrainingSample> elsewhere;
  for (int i = 0; i < 100; ++i) elsewhere.push_back(arriving({0.2F, 0.8F, 0.1F}, {0, 0, 1}, 3, 1));
  lobes.learn(elsewhere);
  const AimedLobes before = lobes;
  lobes.next_round();
  Rng rng(48, 0, 0, Rng::Purpose::test);
  for (int i = 0; i < 1000; ++i) {
    const V3f x = place(rng, 1), w = i % 2 == 0 ? (target - x).normalized() : direction(rng);
    const float p = before.pdf(x, w).value;
    EXPECT_NEAR(lobes.pdf(x, w).value, p, 1e-3F * p + 1e-6F) << x << w;
  }
}

/// Light that comes from one direction at each of `n` places, from surfaces so near or far.
std::vector<TrainingSample> from_everywhere(const V3f& w, float nearest, float farthest, int n) {
  Rng rng(49, 0, 0, Rng::Purpose::test);
  std::vector<TrainingSample> batch;
  batch.reserve(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    const V3f x = place(rng, 0.5F);
    batch.push_back(arriving(x, w, nearest + (farthest - nearest) * rng.next(), 1));
  }
  return batch;
}

// Walls beside each place: seen from one pivot the light would come from all sides.
TEST(AimedLobes, AreNotAimedAtLightThatComesAlong) {
  const V3f w = V3f(1, 2, 2) / 3.0F;
  AimedLobes lobes;
  for (int round = 0; round < 3; ++round) {
    lobes.learn(from_everywhere(w, 0.05F, 0.3F, 2000));
    lobes.next_round();
  }
  Rng rng(50, 0, 0, Rng::Purpose::test);
  for (int i = 0; i < 100; ++i) EXPECT_GT(lobes.pdf(place(rng, 0.5F), w).value, 100) << i;
}

// Of light from one place, and light that comes along, each has lobes of its own.
TEST(AimedLobes, TellAPlaceFromADirection) {
  const V3f target(0.5F, 1.5F, 1), w(0, 0, -1);
  AimedLobes lobes;
  for (int round = 0; round < 5; ++round) {
    std::vector<TrainingSample> batch = from_everywhere(w, 0.05F, 0.3F, 2000);
    Rng rng(51, static_cast<std::uint64_t>(round), 0, Rng::Purpose::test);
    for (int i = 0; i < 2000; ++i) {
      const V3f x = place(rng, 0.5F), d = target - x;
      batch.push_back(arriving(x, d.normalized(), d.length(), 1));
    }
    lobes.learn(batch);
    lobes.next_round();
  }
  Rng rng(52, 0, 0, Rng::Purpose::test);
  statistics::Moments placed, along;
  for (int i = 0; i < 1000; ++i) {
    const V3f x = place(rng, 0.5F);
    placed.add(std::log(double(lobes.pdf(x, (target - x).normalized()).value)));
    along.add(std::log(double(lobes.pdf(x, w).value)));
  }
  EXPECT_GT(placed.mean(), std::log(20.0));
  EXPECT_GT(along.mean(), std::log(20.0));
}

TEST(AimedLobes, AreNotCarriedAwayByOneSample) {
  const auto light = [](const V3f& w) { return w.x > 0.9F ? 1.0F : 0; };
  AimedLobes lobes = lobes_of(light, 4000);
  const float before = lobes.pdf({0, 0, 0}, {1, 0, 0}).value;
  const std::array<TrainingSample, 1> rare{arriving({0, 0, 0}, {-1, 0, 0}, 2, 1e12F)};
  lobes.learn(rare);
  EXPECT_GT(lobes.pdf({0, 0, 0}, {1, 0, 0}).value, 0.6F * before);
  EXPECT_GT(lobes.pdf({0, 0, 0}, {-1, 0, 0}).value, 0);
}

TEST(AimedLobes, AreWideWhereOneSampleTells) {
  AimedLobes lobes;
  lobes.learn(std::vector<TrainingSample>{arriving({0, 0, 0}, {0, 0, 1}, HUGE_VALF, 1)});
  const float angle = pi / 9;
  EXPECT_GT(lobes.pdf({0, 0, 0}, {std::sin(angle), 0, std::cos(angle)}).value, uniform_density);
}

// All lobes are narrow and far from it: none has a density there that a float can tell.
TEST(AimedLobes, FindNewLight) {
  AimedLobes lobes;
  const auto teach = [&lobes](const std::vector<V3f>& axes) {
    std::vector<TrainingSample> batch;
    for (int i = 0; i < 20000; ++i)
      batch.push_back(
          arriving({0, 0, 0}, axes[static_cast<std::size_t>(i) % axes.size()], HUGE_VALF, 1));
    for (int k = 0; k < 4; ++k) lobes.learn(batch);
  };
  std::vector<V3f> old;
  for (int i = 0; i < 40; ++i)
    old.push_back(V3f(std::cos(0.1F * float(i)), std::sin(0.1F * float(i)), 1).normalized());
  teach(old);
  const V3f below(0, 0, -1);
  ASSERT_LT(lobes.pdf({0, 0, 0}, below).value, 1e-3F);
  teach({below});
  EXPECT_GT(lobes.pdf({0, 0, 0}, below).value, 10 * uniform_density);
}

TEST(AimedLobes, AreTheSameAtEachScale) {
  const auto scaled = [](float places, float weights) {
    Rng rng(46, 0, 0, Rng::Purpose::test);
    AimedLobes lobes;
    std::vector<TrainingSample> batch;
    for (int i = 0; i < 500; ++i) {
      const V3f x = place(rng, 1) * places;
      batch.push_back(arriving(x, direction(rng), places * (1 + rng.next()), weights * rng.next()));
    }
    lobes.learn(batch);
    lobes.next_round();
    lobes.learn(batch);
    return lobes;
  };
  const AimedLobes plain = scaled(1, 1);
  for (const auto& [s, w] : {std::pair{0x1p-50F, 0x1p40F}, std::pair{0x1p50F, 0x1p-80F}}) {
    const AimedLobes other = scaled(s, w);
    Rng rng(47, 0, 0, Rng::Purpose::test);
    for (int i = 0; i < 100; ++i) {
      const V3f x = place(rng, 1), d = direction(rng);
      EXPECT_EQ(plain.pdf(x, d).value, other.pdf(x * s, d).value);
    }
  }
}

TEST(AimedLobes, GoOnAsTheyWereSaved) {
  AimedLobes lobes = aimed({0, 0, 4}, true, 100);
  ByteWriter out;
  lobes.save(out);
  AimedLobes loaded;
  ByteReader in(out.bytes());
  loaded.load(in);
  const std::array<TrainingSample, 1> more{arriving({0, 1, 0}, {1, 0, 0}, 2, 3)};
  for (AimedLobes* l : {&lobes, &loaded}) {
    l->learn(more);
    l->next_round();
  }
  ByteWriter a, b;
  lobes.save(a);
  loaded.save(b);
  EXPECT_EQ(a.bytes(), b.bytes());
}

TEST(AimedLobes, ThatAreNotNumbersAreRefused) {
  ByteWriter out;
  aimed({0, 0, 4}, true, 100).save(out);
  for (const double bad : {double(NAN), double(INFINITY), -1.0}) {
    std::string bytes(out.bytes());
    // The share of the first lobe.
    std::memcpy(bytes.data() + 12 * sizeof(double), &bad, sizeof bad);
    ByteReader in(bytes);
    AimedLobes lobes;
    EXPECT_THROW(lobes.load(in), std::runtime_error) << bad;
  }
}

TEST(AimedLobes, WithoutLightNothingIsKnown) {
  AimedLobes lobes;
  lobes.learn({});
  lobes.next_round();
  EXPECT_TRUE(lobes.empty());
}

}  // namespace
}  // namespace lacuna
