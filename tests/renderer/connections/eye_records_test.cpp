// What light vertices give to records on surfaces, by its definition.

#include "renderer/connections/eye_records.h"

#include <gtest/gtest.h>

#include "tests/renderer/connections/lit_scene.h"

namespace lacuna {
namespace {

using test::Lit;

/// Of a connection of `eye` and vertex `i` of the light paths with `s` vertices.
struct Parts {
  double bounded = 0, unshadowed = 0;
  double weight = 0;  ///< MIS
  bool visible = false;
};
Parts parts_of(const Lit& lit, const EyeRecords::Record& record, int s, std::size_t i) {
  Parts parts;
  const Vertex& x = record.vertex;
  lit.lights.with_end(s, i, lit.guide, [&](const auto& light) {
    const bool infinite = at_infinity(light);
    const V3f edge = infinite ? light.x() : light.x() - x.surface.x;
    const float d2 = infinite ? 1 : edge.length2();
    if (!(d2 > 0)) return;
    const V3f w = edge.normalized();
    const Rgb given = light.scatter(-w);
    const Rgb arriving = x.bsdf->eval(x.wp, w, Transport::radiance) * given / d2;
    if (is_black(arriving)) return;
    parts.bounded = double(luminance(given));
    parts.unshadowed = double(luminance(arriving));
    const SurfaceEndpoint eye{x, record.depth, Transport::radiance, lit.guide};
    const Connection c = connect(eye, light);
    parts.weight = weight(eye, light, c, Lit::counts);
    const std::vector<Ray> ray{shadow_ray(eye, light, c)};
    std::vector<std::uint8_t> occluded(1);
    lit.scene.rays().occluded(ray, occluded);
    parts.visible = occluded[0] == 0;
  });
  return parts;
}

TEST(EyeRecords, HaveWhatLightVerticesGiveThem) {
  const ThreadPool pool(1);
  const std::function<bool()> never = [] { return false; };
  const WantedContributions all{.full = true, .unshadowed = true, .bounded = true};
  WantedContributions weighted = all;
  weighted.weighted = true;
  int hidden = 0, seen = 0, shared = 0;
  for (const test::PathScene& s : test::path_scenes()) {
    SCOPED_TRACE(s.name);
    const Lit lit(s);
    const IterationContext context{lit.scene, lit.camera, pool, 111, 0, never};
    EyeRecords records;
    Counters counters;
    records.place(context, lit.lights, 0.1, lit.lights.longest(), counters);
    for (std::size_t r = 0; r < records.size(); ++r) {
      EXPECT_GE(records[r].depth, 1);
      for (int n = 1; n <= lit.lights.longest(); ++n) {
        const RecordContributions plain = contributions_to(records[r], context, lit.lights, n, all);
        const RecordContributions by_mis =
            contributions_to(records[r], context, lit.lights, n, weighted);
        ASSERT_EQ(plain.full.size(), lit.lights.count(n));
        for (std::size_t i = 0; i < plain.full.size(); ++i) {
          const Parts p = parts_of(lit, records[r], n, i);
          const double u = p.unshadowed;
          EXPECT_NEAR(plain.bounded[i], p.bounded, 1e-4 * p.bounded);
          EXPECT_NEAR(plain.unshadowed[i], u, 1e-4 * u);
          EXPECT_EQ(plain.full[i], p.visible ? plain.unshadowed[i] : 0);
          EXPECT_NEAR(by_mis.unshadowed[i], u * p.weight, 1e-4 * u);
          EXPECT_EQ(by_mis.full[i], p.visible ? by_mis.unshadowed[i] : 0);
          EXPECT_EQ(by_mis.bounded[i], plain.bounded[i]);
          if (!(u > 0)) continue;
          ++(p.visible ? seen : hidden);
          shared += p.weight < 0.9 ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(seen, 1000);
  EXPECT_GT(hidden, 1000);
  EXPECT_GT(shared, 1000);
}

TEST(EyeRecords, GiveNothingThatIsNotWanted) {
  const ThreadPool pool(1);
  const std::function<bool()> never = [] { return false; };
  const Lit lit(test::path_scenes().front());
  const IterationContext context{lit.scene, lit.camera, pool, 112, 0, never};
  EyeRecords records;
  Counters counters;
  records.place(context, lit.lights, 0.05, lit.lights.longest(), counters);
  ASSERT_GT(records.size(), 0U);
  const auto total = [](const std::vector<double>& v) {
    double sum = 0;
    for (const double x : v) sum += x;
    return sum;
  };
  const RecordContributions none =
      contributions_to(records[0], context, lit.lights, 2, {.full = false});
  EXPECT_EQ(none.rays, 0U);
  EXPECT_EQ(total(none.full) + total(none.unshadowed) + total(none.bounded), 0);
  const RecordContributions full = contributions_to(records[0], context, lit.lights, 2, {});
  EXPECT_GT(full.rays, 0U);
  EXPECT_EQ(total(full.unshadowed) + total(full.bounded), 0);
}

}  // namespace
}  // namespace lacuna
