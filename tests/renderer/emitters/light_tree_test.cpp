#include "renderer/emitters/light_tree.h"

#include <gtest/gtest.h>

#include <map>

#include "renderer/core/sampling.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

enum class Sort { points, lamps, signs, spots, mixed, meshes };
constexpr std::array all_sorts{Sort::points, Sort::lamps, Sort::signs,
                               Sort::spots,  Sort::mixed, Sort::meshes};
constexpr double extent = 10;       ///< of the box below, for bundles
constexpr int triangles_each = 64;  ///< of a mesh

V3f any_direction(Rng& rng) {
  const V2f u = rng.next2();
  const float z = 1 - 2 * u.x;
  const float s = std::sqrt(std::max(0.0F, 1 - z * z));
  return {s * std::cos(2 * pi * u.y), s * std::sin(2 * pi * u.y), z};
}

V3f place(Rng& rng) {
  const V2f a = rng.next2();
  return {10 * a.x, 10 * a.y, 2 * rng.next()};
}

/// Emitters in a box of 10 x 10 x 2; powers of `decades` decades. Meshes are round and of 5 cm.
std::vector<TreeEmitter> scatter(int n, Sort sort, double decades, std::uint64_t seed = 1) {
  Rng rng(seed, 0, 0, Rng::Purpose::test);
  std::vector<TreeEmitter> emitters;
  for (int i = 0; i < n; ++i) {
    TreeEmitter e;
    e.entry = static_cast<std::uint32_t>(2 * i + 1);  // others are not in the tree
    V3f x = place(rng);
    const V3f outwards = any_direction(rng);
    if (sort == Sort::meshes) {
      Rng mesh(seed, 1, static_cast<std::uint64_t>(i / triangles_each), Rng::Purpose::test);
      x = place(mesh) + 0.05F * outwards;
    }
    e.bounds.box.add(x);
    e.bounds.intensity = std::pow(10, decades * (rng.next_choice() - 0.5));
    const Sort one = sort == Sort::mixed ? all_sorts[rng.below(4)] : sort;
    if (one == Sort::points) e.bounds.axes = DirectionCone::everything();
    if (one == Sort::spots) {
      e.bounds.axes = {V3d(any_direction(rng)), rng.next_choice()};
    } else if (one != Sort::points) {
      if (sort != Sort::meshes) e.bounds.box.add(x + 0.1F * any_direction(rng));
      e.bounds.axes = {V3d(sort == Sort::meshes ? outwards : any_direction(rng)), 0};
      e.bounds.reach = std::numbers::pi / 2;
      e.bounds.both_sides = one == Sort::signs;
    }
    emitters.push_back(e);
  }
  return emitters;
}

Receiver receiver(Rng& rng, int kind) {
  Receiver r;
  r.x = place(rng);
  if (kind > 0) {
    r.n = any_direction(rng);
    r.least_cosine = 0.06F;
    r.both_sides = kind == 2;
  }
  return r;
}

double sum_of_probabilities(const LightTree& tree, const std::vector<TreeEmitter>& emitters,
                            const Receiver& at) {
  double sum = 0;
  for (const TreeEmitter& e : emitters) {
    const double p = tree.probability(e.entry, at);
    EXPECT_GT(p, 0) << e.entry;
    EXPECT_LE(p, 1 + 1e-9) << e.entry;
    sum += p;
  }
  return sum;
}

TEST(LightTree, ProbabilitiesAddUpToOne) {
  Rng rng(2, 0, 0, Rng::Purpose::test);
  for (const int n : {1, 2, 3, 8, 9, 64, 65, 1000}) {
    for (const Sort sort : all_sorts) {
      for (const double decades : {0.0, 24.0}) {
        const auto emitters = scatter(n, sort, decades);
        const LightTree tree(emitters, extent);
        for (int kind = 0; kind < 3; ++kind) {
          const double rounding = sort == Sort::meshes ? 1e-6 : 1e-9;  // bundles: floats
          EXPECT_NEAR(sum_of_probabilities(tree, emitters, receiver(rng, kind)), 1, rounding)
              << n << " emitters of sort " << static_cast<int>(sort) << ", receiver " << kind;
        }
      }
    }
  }
}

// The number that choose() gives is that of probability(), bit by bit.
TEST(LightTree, DrawsStateTheirProbability) {
  for (const Sort sort : {Sort::mixed, Sort::meshes}) {
    const auto emitters = scatter(500, sort, 6);
    const LightTree tree(emitters, extent);
    Rng rng(3, 0, 0, Rng::Purpose::test);
    for (int i = 0; i < 5000; ++i) {
      const Receiver at = receiver(rng, i % 3);
      const LightTree::Choice c = tree.choose(at, rng.next_choice(), rng);
      ASSERT_EQ(c.probability, tree.probability(c.entry, at));
      ASSERT_GE(c.rest, 0);
      ASSERT_LT(c.rest, 1);
    }
  }
}

TEST(LightTree, DrawsFollowTheProbabilities) {
  constexpr int draws = 100000;
  Rng rng(4, 0, 0, Rng::Purpose::test);
  for (const int n : {1, 7, 300}) {
    for (const Sort sort : all_sorts) {
      const auto emitters = scatter(n, sort, sort == Sort::mixed ? 12 : 1);
      const LightTree tree(emitters, extent);
      const Receiver at = receiver(rng, n % 3);
      std::map<std::uint32_t, double> count;
      for (int i = 0; i < draws; ++i) ++count[tree.choose(at, rng.next_choice(), rng).entry];
      double chi2 = 0, rest = 0, rest_expected = 0;
      int cells = 0;
      for (const TreeEmitter& e : emitters) {
        const double expected = draws * tree.probability(e.entry, at);
        const double observed = count[e.entry];
        if (expected < 10) {
          rest += observed;
          rest_expected += expected;
          continue;
        }
        chi2 += (observed - expected) * (observed - expected) / expected;
        ++cells;
      }
      if (rest_expected > 10) {
        chi2 += (rest - rest_expected) * (rest - rest_expected) / rest_expected;
        ++cells;
      }
      if (cells < 2) continue;
      EXPECT_GT(chi_square_beyond(chi2, cells - 1), 1e-6)
          << n << " of sort " << static_cast<int>(sort) << ": chi2 " << chi2 << " of " << cells;
    }
  }
}

// Rare emitters are drawn as rarely as they say: of many draws from random numbers of which most
// bits are used up on the way, the mean of 1 / p is their number.
TEST(LightTree, RareEmittersAreDrawnAsRarely) {
  std::vector<TreeEmitter> emitters = scatter(4096, Sort::points, 0);
  const LightTree tree(emitters);
  Rng rng(5, 0, 0, Rng::Purpose::test);
  const Receiver at{V3f(5, 5, 1)};
  statistics::Moments inverse;
  for (int i = 0; i < 200000; ++i)
    inverse.add(1 / tree.choose(at, rng.next_choice(), rng).probability);
  EXPECT_GT(statistics::z_test(inverse, 4096), 1e-5);
}

class InterleavedLightTree : public testing::TestWithParam<Sort> {};
INSTANTIATE_TEST_SUITE_P(Sorts, InterleavedLightTree, testing::Values(Sort::mixed, Sort::meshes));

TEST_P(InterleavedLightTree, DescentsAreTheSame) {
  const auto emitters = scatter(3000, GetParam(), 4);
  const LightTree tree(emitters, extent);
  Rng points(6, 0, 0, Rng::Purpose::test);
  std::vector<LightTree::Request> requests(101);
  std::vector<Rng> together, alone;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    together.emplace_back(7, 0, i, Rng::Purpose::test);
    requests[i].at = receiver(points, static_cast<int>(i % 3));
    requests[i].u = points.next_choice();
  }
  alone = together;
  for (std::size_t i = 0; i < requests.size(); ++i) requests[i].rng = &together[i];
  tree.choose(requests);
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const LightTree::Choice c = tree.choose(requests[i].at, requests[i].u, alone[i]);
    EXPECT_EQ(requests[i].result.entry, c.entry);
    EXPECT_EQ(requests[i].result.rest, c.rest);
    EXPECT_EQ(requests[i].result.probability, c.probability);
    EXPECT_EQ(together[i].next_u32(), alone[i].next_u32());
  }
}

// A mesh of many triangles is drawn from by intensity from afar, and by what each looks like close
// by.
TEST(LightTree, MeshesAreOneEmitterFromAfar) {
  const auto emitters = scatter(triangles_each, Sort::meshes, 1);
  const LightTree whole(emitters, extent), each(emitters, 0);
  const auto ratios = [&](const LightTree& tree, const V3f& x) {
    std::map<long, int> count;  // of probabilities over intensities, in steps of a thousandth
    for (const TreeEmitter& e : emitters) {
      const double p = tree.probability(e.entry, {x});
      ++count[std::lround(1000 * std::log(p / e.bounds.intensity))];
    }
    return count.size();
  };
  const V3f centre(emitters[0].bounds.box.low);
  // Eight children, two triangles at least in each that is a bundle.
  EXPECT_LT(ratios(whole, centre + V3f(5, 0, 0)), emitters.size() / 2);
  EXPECT_GT(ratios(each, centre + V3f(5, 0, 0)), emitters.size() / 2);
  EXPECT_EQ(ratios(whole, centre), ratios(each, centre));
}

// What is left of the number that selects is uniform: it places the point on the emitter.
TEST(LightTree, TheRestIsUniform) {
  const auto emitters = scatter(300, Sort::meshes, 3);
  const LightTree tree(emitters, extent);
  Rng rng(8, 0, 0, Rng::Purpose::test);
  const Receiver at = receiver(rng, 1);
  statistics::Moments rest, square;
  for (int i = 0; i < 200000; ++i) {
    const double r = tree.choose(at, rng.next_choice(), rng).rest;
    rest.add(r);
    square.add(r * r);
  }
  EXPECT_GT(statistics::z_test(rest, 0.5), 1e-5);
  EXPECT_GT(statistics::z_test(square, 1.0 / 3), 1e-5);
}

// At an emitter, and as far away as floats reach: neither weights nor the uniform share get lost.
TEST(LightTree, NoProbabilityIsZeroAtAnyDistance) {
  std::vector<TreeEmitter> emitters;
  for (std::uint32_t i = 0; i < 100; ++i) {
    TreeEmitter e;
    e.entry = i;
    e.bounds.box.add(V3f(i == 0 ? 0 : static_cast<float>(i) * 0.01F, 0, 0));
    e.bounds.axes = {V3d(0, 0, 1), 0};
    e.bounds.reach = std::numbers::pi / 2;
    e.bounds.intensity = std::pow(10.0, -12 + 24 * double(i) / 100);
    emitters.push_back(e);
  }
  const LightTree tree(emitters);
  for (const float x : {0.0F, 1e-30F, 1e-18F, 1e-16F, 1e-12F, 1.0F, 1e9F, 1e12F, 1e15F, 1e16F,
                        1e17F, 1e18F, 1e19F, 1.8e19F, 1e20F, 1e30F, 1e37F}) {
    for (const V3f& at : {V3f(x, 0, 0), V3f(0, 0, -x)}) {
      double sum = 0;
      for (const TreeEmitter& e : emitters) {
        const double p = tree.probability(e.entry, {at, V3f(0, 0, 1), false, 1e-3F});
        ASSERT_GT(p, 0) << x << ' ' << e.entry;
        sum += p;
      }
      ASSERT_NEAR(sum, 1, 1e-6) << x;
    }
  }
}

// Emitters in one place differ by their power only: to the rounding of a node's intensities, 2^-10,
// of four levels.
TEST(LightTree, EqualPositionsAreChosenByPower) {
  constexpr int n = 1000;
  std::vector<TreeEmitter> emitters;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    TreeEmitter e;
    e.entry = static_cast<std::uint32_t>(i);
    e.bounds.box.add(V3f(1, 2, 3));
    e.bounds.axes = DirectionCone::everything();
    e.bounds.intensity = 1 + i % 7;
    sum += e.bounds.intensity;
    emitters.push_back(e);
  }
  const LightTree tree(emitters);
  for (const V3f& x : {V3f(1, 2, 3), V3f(0, 0, 0), V3f(1e18F, 0, 0)}) {
    for (const TreeEmitter& e : emitters) {
      ASSERT_NEAR(tree.probability(e.entry, {x}) / (e.bounds.intensity / sum), 1, 4 * 0x1p-10);
    }
  }
}

// Where light arrives, the probability is not below what the contribution calls for by orders:
// points within, on and between spheres, behind surfaces, along them.
TEST(LightTree, LightThatArrivesIsNeverRare) {
  const auto emitters = scatter(200, Sort::lamps, 0);
  const LightTree tree(emitters);
  Rng rng(8, 0, 0, Rng::Purpose::test);
  for (int i = 0; i < 2000; ++i) {
    Receiver at = receiver(rng, 1);
    if (i % 2 == 0) at.x = V3f(emitters[rng.below(200)].bounds.box.low);
    double sum = 0, least_ratio = 1e30;
    for (const TreeEmitter& e : emitters) {
      const V3d to = (e.bounds.box.low + e.bounds.box.high) / 2 - V3d(at.x);
      const double d2 = to.length2();
      const double c = e.bounds.intensity * std::max(0.0, to.dot(V3d(at.n))) *
                       std::max(0.0, -to.dot(e.bounds.axes.axis)) / (d2 * std::max(d2, 0.01));
      sum += c;
      if (c > 0) least_ratio = std::min(least_ratio, tree.probability(e.entry, at) / c);
    }
    if (sum > 0) {
      ASSERT_GT(least_ratio * sum, 1e-6) << i;
    }
  }
}

TEST(LightTree, BrightAndNearEmittersAreFavoured) {
  const auto emitters = scatter(1000, Sort::points, 0);
  const LightTree tree(emitters);
  double nearest = 0;
  for (std::size_t i = 0; i < 50; ++i) {
    const V3f x(emitters[i].bounds.box.low + V3d(0, 0, 0.01));
    nearest += tree.probability(emitters[i].entry, {x}) / 50;
  }
  EXPECT_GT(nearest, 0.03);  // 0.001 by power
}

TEST(LightTree, NoEmitters) {
  const LightTree tree;
  EXPECT_TRUE(tree.empty());
  EXPECT_EQ(tree.probability(0, {}), 0);
}

TEST(DirectionCone, JoinedConesContainBoth) {
  Rng rng(9, 0, 0, Rng::Purpose::test);
  for (int i = 0; i < 2000; ++i) {
    const DirectionCone a{V3d(any_direction(rng)).normalized(), rng.next_choice() * 2};
    const DirectionCone b{V3d(any_direction(rng)).normalized(), rng.next_choice() * 2};
    const DirectionCone both = DirectionCone::join(a, b);
    for (const DirectionCone& c : {a, b}) {
      const double angle = std::acos(std::clamp(c.axis.dot(both.axis), -1.0, 1.0));
      EXPECT_LE(std::min(angle + c.spread, std::numbers::pi), both.spread + 1e-6);
    }
  }
}

}  // namespace
}  // namespace lacuna
