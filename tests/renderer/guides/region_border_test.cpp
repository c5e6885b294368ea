// Regions' ways of drawing pass into one another: no step at their borders.

#include <gtest/gtest.h>

#include "renderer/gltf/gltf_load.h"
#include "tests/renderer/guides/guided_scene.h"
#include "tests/renderer/path/scenes.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

using statistics::Moments;
using test::GuidedScene;

/// Total variation between what is drawn at two points, in [0, 1]; draws that fail count too.
double difference(const GuidingDistribution& d, const GuidedVertex& a, const GuidedVertex& b,
                  Rng& rng) {
  const int n = 400;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    // Half the draws from either, so that no ratio is large.
    const bool first = i % 2 == 0;
    const auto w = d.sample(first ? a : b, rng.next_fine_point(), rng);
    if (!w) continue;
    const double pa = double(a.cell.probability) * double(d.pdf(a, *w).value);
    const double pb = double(b.cell.probability) * double(d.pdf(b, *w).value);
    const double drawn = pa / double(a.cell.probability) + pb / double(b.cell.probability);
    if (drawn > 0) sum += std::abs(pa - pb) / drawn / n;
  }
  return sum;
}

TEST(RegionBorders, ShowNoStepWithMixing) {
  PortalsGuideSettings settings;
  settings.probability = {0.5};
  settings.mixing = 0;
  const auto make = [] { return load_gltf(test::own_scene("ajar.glb")); };
  const GuidedScene sharp(make, settings, 0, std::nullopt, 48);
  settings.mixing = 4;
  const GuidedScene mixed(make, settings, 0, std::nullopt, 48);
  Rng rng(31, 0, 0, Rng::Purpose::test);
  Moments step_sharp, step_mixed, gain;  // of the borders beside one vertex: these are alike
  for (const Vertex& v : sharp.guided_vertices(60)) {
    Moments of_sharp, of_mixed;
    const GuidingDistribution &one = sharp.directions(), &other = mixed.directions();
    // Along the surface, in steps of a tenth of a voxel.
    const V3f along = cross(v.surface.ng, V3f(0.3F, 0.5F, 0.8F)).normalized() * 0.013F;
    Surface s = v.surface, next = v.surface;
    for (int k = 0; k < 100; ++k) {
      s.x = next.x;
      next.x += along;
      const GuidingCell a = one.cell(s, v.wp), b = one.cell(next, v.wp);
      if (!(a.probability > 0 && b.probability > 0) || a.index == b.index) continue;
      const double step = difference(one, {s, *v.bsdf, v.wp, a}, {next, *v.bsdf, v.wp, b}, rng);
      if (step < 0.1) continue;  // no border of regions
      const GuidingCell ma = other.cell(s, v.wp), mb = other.cell(next, v.wp);
      if (!(ma.probability > 0 && mb.probability > 0)) continue;
      of_sharp.add(step);
      of_mixed.add(difference(other, {s, *v.bsdf, v.wp, ma}, {next, *v.bsdf, v.wp, mb}, rng));
    }
    if (of_sharp.count() == 0) continue;
    step_sharp.add(of_sharp.mean());
    step_mixed.add(of_mixed.mean());
    gain.add(of_sharp.mean() - 1.5 * of_mixed.mean());
  }
  EXPECT_GE(gain.count(), 10U);
  // Measured is a third of the step, 0.086 and 0.260, six standard errors from two thirds.
  EXPECT_GT(statistics::t_test_at_least(gain, 0), 0.99)
      << "beside " << gain.count() << " vertices " << step_sharp.mean() << " +- "
      << step_sharp.standard_error() << " and " << step_mixed.mean() << " +- "
      << step_mixed.standard_error();
}

}  // namespace
}  // namespace lacuna
