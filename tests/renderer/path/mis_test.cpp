// The recursive weights of multiple importance sampling against their definition.

#include "renderer/path/mis.h"

#include <gtest/gtest.h>

#include <set>

#include "renderer/path/guide.h"
#include "renderer/path/next_event.h"
#include "tests/renderer/path/oracle.h"
#include "tests/renderer/path/scenes.h"
#include "tests/renderer/path/scripted.h"
#include "tests/renderer/path/sided_directions.h"

namespace lacuna {
namespace {

using test::DirectionsOf;
using test::Oracle;
using test::PathFromEye;
using test::PathScene;
using test::WholePath;

constexpr int side = 16;  // of the film, pixels
constexpr int longest = 6;

struct Counts {
  const char* name;
  SampleCounts n;
};
const std::vector<Counts> all_counts{{"path", {1, 1, 0, 0}},
                                     {"light", {0, 0, 0, 100}},
                                     {"paired", {1, 1, 1, side* side}},
                                     {"resampled", {1, 37, 37, side* side}},
                                     {"counted as eight", {1, 1, 8, 1000}},
                                     {"merged", {1, 1, 1, side* side, 2}},
                                     {"merged more", {1, 1, 1, side* side, 30}}};
/// Weights by a light tree, wherever next event estimation is part of them.
const std::vector<Counts> tree_counts{{"path", {1, 1, 0, 0}}, {"paired", {1, 1, 1, side* side}}};
/// That makes all paths.
const SampleCounts complete_counts{1, 1, 1, side* side};

/// Real walks from both ends, which meet in all ways.
class Meeting {
 public:
  Meeting(const Scene& scene, const Camera& camera, const SampleCounts& n, const Guide& guide,
          EmitterChoice emitters = EmitterChoice::power)
      : scene_(scene),
        camera_(camera),
        counts_(n),
        guide_(guide),
        emitters_(emitters),
        next_event_(scene, emitters),
        eye_(longest),
        light_(setting_, guide_) {}

  /// Calls `hit(path, weight)`, and `joined(path, s, weight, visible)`, for all that the walks of
  /// so many rounds give.
  template <class Hit, class Joined>
  void meet(int rounds, const Hit& hit, const Joined& joined) {
    for (int round = 0; round < rounds; ++round) {
      std::vector<Rng> rngs;
      for (std::size_t i = 0; i < EyeBatch::size; ++i) {
        rngs.emplace_back(71, static_cast<std::uint64_t>(round), i, Rng::Purpose::light_path);
      }
      Counters counters;
      light_.walk(rngs, counters);
      eye_.states.clear();
      for (std::size_t i = 0; i < EyeBatch::size; ++i) {
        Rng rng(71, static_cast<std::uint64_t>(round), i);
        const float x = rng.next() * side;
        eye_.start(camera_, rng, camera_.ray(x, rng.next() * side), 0);
        join_eye(i, joined);
      }
      Walk walk(scene_, guide_,
                {.max_depth = longest, .roulette_depth = longest + 1, .counts = eye_side(counts_)},
                counters);
      walk.trace_paths(eye_.states, [&](std::size_t i, int depth) {
        meet_emitter(i, depth, hit);
        join(i, depth, joined);
      });
    }
  }

 private:
  PathFromEye from_eye(std::size_t i, int depth, bool joined) const {
    PathFromEye path(camera_.position());
    for (int j = 1; j <= depth; ++j) path.add(eye_.vertex(i, j), joined && j == depth);
    return path;
  }
  WholePath whole(std::size_t i, int depth, const EmitterPoint& e, int s, const V3f& w) const {
    return from_eye(i, depth, true)
        .finish(
            e, s, [&](int j) -> const Vertex& { return light_.vertex(i, j); }, w);
  }

  template <class Hit>
  void meet_emitter(std::size_t i, int depth, const Hit& hit) const {
    const Vertex& v = eye_.vertex(i, depth);
    auto e = emitter_at(scene_, v);
    if (!e) return;
    next_event_.set_ratio(*e, v, eye_.vertex(i, depth - 1), depth);
    const auto none = [&](int) -> const Vertex& { return v; };
    hit(from_eye(i, depth - 1, false).finish(*e, 1, none, -v.wp),
        hit_weight(v, depth, *e, counts_, guide_));
  }

  /// t = 1.
  template <class Joined>
  void join_eye(std::size_t i, const Joined& joined) const {
    const EyeEndpoint eye{camera_, camera_.position()};
    for (int s = 1; s <= light_.length(i); ++s) {
      const EmitterPoint& e = light_.emitter(i);
      const V3f& x = s == 1 ? e.x : light_.vertex(i, s - 1).surface.x;
      const V3f w = s == 1 && e.infinite() ? x : (x - camera_.position()).normalized();
      if (!camera_.project(w)) continue;
      if (s == 1) {
        if (!e.delta()) use(eye, EmitterEndpoint{e, guide_}, i, 0, joined);
      } else if (light_.vertex(i, s - 1).bsdf->connectible()) {
        use(eye, light_.end(i, s - 1), i, 0, joined);
      }
    }
  }

  template <class Joined>
  void join(std::size_t i, int depth, const Joined& joined) {
    const Vertex& v = eye_.vertex(i, depth);
    if (v.kind != Vertex::Kind::surface || depth == longest || !v.bsdf->connectible()) return;
    const SurfaceEndpoint eye{v, depth, Transport::radiance, guide_};
    for (int s = 1; s <= std::min(longest - depth, light_.length(i)); ++s) {
      if (s == 1) {
        EmitterPoint e = light_.emitter(i);
        e.next_event_ratio = next_event_.ratio(e, v);
        use(eye, EmitterEndpoint{e, guide_}, i, depth, joined);
      } else if (light_.vertex(i, s - 1).bsdf->connectible()) {
        use(eye, light_.end(i, s - 1), i, depth, joined);
      }
    }
  }

  template <class Eye, class Light, class Joined>
  void use(const Eye& eye, const Light& light, std::size_t i, int depth,
           const Joined& joined) const {
    const Connection c = connect(eye, light);
    const int s = light.index + 1;
    if (!c || samples(s, depth + 1) == 0) return;
    joined(whole(i, depth, light_.emitter(i), s, c.w), s, weight(eye, light, c, counts_),
           !scene_.rays().occluded(shadow_ray(eye, light, c)));
  }
  double samples(int s, int t) const {
    if (t == 1) return counts_.splat;
    return s == 1 ? counts_.nee : counts_.connect;
  }

  const Scene& scene_;
  const Camera& camera_;
  SampleCounts counts_;
  const Guide& guide_;
  EmitterChoice emitters_;
  NextEvent next_event_;
  EyeBatch eye_;
  LightPathSetting setting_{scene_, camera_, longest, longest + 1, counts_, false, emitters_};
  LightBatch light_;
};

/// Calls `test(guide, guided, directions)` with the guide that follows the BSDF, and with those
/// that mix `directions` in: from the eye, from the lights, other ones from both.
template <class Test>
void for_all_guides(const Test& test) {
  {
    SCOPED_TRACE("bsdf");
    test(Guide{}, false, DirectionsOf{});
  }
  for (const auto& [name, from_eye, from_light] :
       {std::tuple{"eye", true, false}, {"light", false, true}, {"both", true, true}}) {
    SCOPED_TRACE(name);
    auto eye = from_eye ? std::make_unique<test::SidedDirections>() : nullptr;
    auto light = from_light ? std::make_unique<test::SidedDirections>(-1.0F) : nullptr;
    const DirectionsOf directions{eye.get(), light.get()};
    const Guide guide(std::move(eye), std::move(light));
    test(guide, true, directions);
  }
}

class Weights : public testing::TestWithParam<PathScene> {
 protected:
  Weights() : data_(load(GetParam())) {}
  void are_their_definition(const Guide& guide, const DirectionsOf& directions) const;
  void add_up_to_one(const Guide& guide, bool guided, const DirectionsOf& directions) const;

  SceneData data_;
  const Camera camera_{data_.cameras.front(), side, side};
  const Scene scene_ = test::lit_scene(std::move(data_), environment(GetParam()));
};

/// How far weights lie from what they should be.
struct Comparison {
  double tolerance;  ///< relative
  double smallest;   ///< relative to this where less is expected
  int compared = 0, apart = 0;
  double worst = 0;
  std::set<std::pair<int, int>> strategies = {};

  void add(double found, double expected, int s, int t) {
    ++compared;
    strategies.insert({s, t});
    const double off = std::abs(found - expected) / std::max(expected, smallest);
    if (!(off <= tolerance)) ++apart;  // NaN is apart, too
    worst = std::max(worst, off);
  }
};

/// What a comparison must have seen to mean anything: little where only what goes straight to the
/// eye counts.
void expect_power(const Comparison& c, const SampleCounts& n) {
  EXPECT_GE(c.compared, n.connect > 0 ? 90 : 1);
  EXPECT_GE(c.strategies.size(), n.connect > 0 ? 2U : 1U);
}

// Real walks: what the renderer weighs, along the walks' own directions, so that only rounding is
// left.
TEST_P(Weights, AreTheirDefinition) {
  for_all_guides([this](const auto& guide, bool, const DirectionsOf& directions) {
    are_their_definition(guide, directions);
  });
}
void Weights::are_their_definition(const Guide& guide, const DirectionsOf& directions) const {
  for (const Counts& counts : all_counts) {
    SCOPED_TRACE(counts.name);
    Comparison c{.tolerance = 1e-5, .smallest = 1e-9};
    int impossible = 0;
    const auto compare = [&](const WholePath& path, int s, double weight) {
      const double expected =
          Oracle(scene_, camera_, path, directions).weights(counts.n)[static_cast<std::size_t>(s)];
      impossible += expected > 0 ? 0 : 1;
      c.add(weight, expected, s, path.edges() + 1 - s);
    };
    Meeting(scene_, camera_, counts.n, guide)
        .meet(
            6,
            [&](const WholePath& path, double weight) {
              if (counts.n.hit > 0) compare(path, 0, weight);
            },
            [&](const WholePath& path, int s, double weight, bool) { compare(path, s, weight); });
    EXPECT_EQ(c.apart, 0) << "of " << c.compared << "; the worst by " << c.worst;
    EXPECT_EQ(impossible, 0) << "were made by a strategy that cannot make them";
    expect_power(c, counts.n);
  }
}

/// EmitterPoint::next_event_ratio of a whole path.
double next_event_ratio(const Scene& scene, const WholePath& path) {
  if (path.edges() < 2 || path.node(1).delta || !path.node(1).bsdf->connectible()) return 1;
  Vertex v;
  v.kind = Vertex::Kind::surface;
  v.surface = path.node(1).surface;
  v.bsdf = path.node(1).bsdf;
  v.wp = path.towards_eye(1);
  return double(NextEvent(scene, EmitterChoice::tree).ratio(path.emitter, v));
}

// The same where next event estimation selects emitters by a light tree.
TEST_P(Weights, ByATreeAreTheirDefinition) {
  std::set<double> ratios;
  for (const Counts& counts : tree_counts) {
    SCOPED_TRACE(counts.name);
    Comparison c{.tolerance = 2e-5, .smallest = 1e-9};
    const auto compare = [&](const WholePath& path, int s, double weight) {
      const double ratio = next_event_ratio(scene_, path);
      ratios.insert(ratio);
      const double expected =
          Oracle(scene_, camera_, path).weights(counts.n, ratio)[static_cast<std::size_t>(s)];
      c.add(weight, expected, s, path.edges() + 1 - s);
    };
    const Guide guide;
    Meeting(scene_, camera_, counts.n, guide, EmitterChoice::tree)
        .meet(
            6, [&](const WholePath& path, double weight) { compare(path, 0, weight); },
            [&](const WholePath& path, int s, double weight, bool) { compare(path, s, weight); });
    EXPECT_EQ(c.apart, 0) << "of " << c.compared << "; the worst by " << c.worst;
    expect_power(c, counts.n);
  }
  // The two triangles of a rectangle have the same bounds: the tree selects them as power does.
  if (scene_.emitters().size() > 2) {
    EXPECT_GT(ratios.size(), 2U) << "the test has no power";
  }
}

// The power heuristic of two techniques, from the weights of the balance heuristic.
TEST(PowerHeuristic, IsThatOfSquaredDensities) {
  for (const double p : {1e-9, 0.1, 1.0, 3.0, 1e9}) {
    const double q = 1;
    EXPECT_NEAR(power_of_two(p / (p + q)) / (p * p / (p * p + q * q)), 1, 1e-12);
    EXPECT_NEAR(power_of_two(p / (p + q)) + power_of_two(q / (p + q)), 1, 1e-12);
  }
  EXPECT_EQ(power_of_two(0), 0);
  EXPECT_EQ(power_of_two(1), 1);
}

// Whole paths, each made once more by every technique: what one walk knows of the other's densities
// is what the other has.
TEST_P(Weights, OfAllStrategiesAddUpToOne) {
  for_all_guides([this](const auto& guide, bool guided, const DirectionsOf& directions) {
    add_up_to_one(guide, guided, directions);
  });
}
void Weights::add_up_to_one(const Guide& guide, bool guided, const DirectionsOf& directions) const {
  std::vector<Counts> counts_and_photons = all_counts;
  counts_and_photons.push_back({"photons", {1, 0, 0, 0, 0.5}});  // which join nothing
  for (const Counts& counts : counts_and_photons) {
    SCOPED_TRACE(counts.name);
    std::vector<WholePath> paths;
    Meeting(scene_, camera_, counts.n.merge > 0 ? complete_counts : counts.n, guide)
        .meet(
            4, [&](const WholePath& path, double) { paths.push_back(path); },
            [&](const WholePath& path, int, double, bool visible) {
              if (visible) paths.push_back(path);
            });
    // Other walks meet the same triangles in slightly other places: rays start off the surface.
    Comparison weights{.tolerance = 2e-3, .smallest = 0.01};
    Comparison sums{.tolerance = 1e-3, .smallest = 1};
    int tried = 0, lost = 0;
    const std::size_t stride = paths.size() / 500 + 1;
    for (std::size_t i = 0; i < paths.size(); i += stride) {
      const WholePath& path = paths[i];
      const std::vector<double> expected =
          Oracle(scene_, camera_, path, directions).weights(counts.n);
      test::Remake remake(scene_, camera_, path, counts.n, guide);
      double sum = 0;
      bool complete = true;
      for (std::size_t s = 0; s < expected.size(); ++s) {
        const double w = expected[s];
        if (w == 0) continue;
        const std::optional<double> found = remake.weight(static_cast<int>(s));
        complete = complete && found;
        if (!found) continue;
        sum += *found;
        weights.add(*found, w, static_cast<int>(s), path.edges() + 1 - static_cast<int>(s));
      }
      ++tried;
      lost += complete ? 0 : 1;
      // Counts that leave techniques out may leave a path none.
      if (complete && sum > 0) sums.add(sum, 1, 0, 0);
    }
    EXPECT_LE(weights.apart, weights.compared / 100) << "the worst by " << weights.worst;
    EXPECT_LE(sums.apart, sums.compared / 100) << "the worst by " << sums.worst;
    // Guided walks also go where they only just fit through.
    EXPECT_LE(lost, 2 + tried / (guided ? 10 : 25))
        << "of " << tried << " paths could not be made again";
    EXPECT_GT(sums.compared, 0);
    expect_power(weights, counts.n);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Weights, testing::ValuesIn(test::path_scenes()),
                         [](const auto& scene) { return scene.param.name; });

}  // namespace
}  // namespace lacuna
