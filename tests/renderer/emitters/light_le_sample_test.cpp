// The first edge of light paths: directions and places follow pdf_Le(), and what they carry is
// the emitter's power.

#include "renderer/emitters/light_le_sample.h"

#include <gtest/gtest.h>

#include "tests/sphere_chi_square.h"

namespace lacuna {
namespace {

using Kind = EmitterPoint::Kind;

const Bounds unit_box = [] {
  Bounds b;
  b.add(V3f(0, 0, 0));
  b.add(V3f(1, 1, 1));
  return b;
}();

constexpr float half_pi = std::numbers::pi_v<float> / 2;

EmitterPoint emitter(Kind kind, const V3f& ng = V3f(1, -2, 0.5F).normalized()) {
  EmitterPoint e;
  e.kind = kind;
  e.x = V3f(0.25F, 0.5F, 0.75F);
  e.offset = 0x1p-19F;
  e.ng = ng;
  e.emission = Rgb(1, 2, 3);
  e.pdf = Pdf<Area>(0.25F);
  return e;
}

EmitterPoint spot(float inner, float outer) {
  EmitterPoint e = emitter(Kind::spot);
  e.cones = SpotCones(inner, outer);
  return e;
}

/// The width of a SphereGrid of whose rings just half lie within `angle` of its pole: quadrature
/// does not see a jump inside a cell.
double width_for(double angle) {
  double low = 1e-6, high = 1e6;
  for (int i = 0; i < 100; ++i) {
    const double width = std::sqrt(low * high);
    const double share = std::asinh(angle / width) / std::asinh(std::numbers::pi / width);
    (share > 0.5 ? low : high) = width;
  }
  return low;
}

/// Directions of `e` against pdf_Le() of `claimed`; `angle` is where either jumps.
statistics::ChiSquare directions(const EmitterPoint& e, double angle, const EmitterPoint& claimed) {
  const statistics::SphereGrid grid(e.ng, width_for(angle));
  Rng rng(31, 0, 0, Rng::Purpose::test);
  return statistics::sphere_chi_square(
      std::span(&grid, 1), [](const V3f&) { return std::size_t{0}; }, 200000,
      [&]() -> std::optional<V3f> {
        const auto l = sample_Le(e, unit_box, rng);
        return l ? std::optional(l->ray.d) : std::nullopt;
      },
      [&](const V3f& w) { return claimed.pdf_Le(w).value; });
}

TEST(LightLeSample, DirectionsFollowTheirDensity) {
  EmitterPoint both = emitter(Kind::area);
  both.both_sides = true;
  const std::vector<std::tuple<const char*, EmitterPoint, double>> cases{
      {"one side", emitter(Kind::area), half_pi},
      {"both sides", both, half_pi},
      {"point", emitter(Kind::point), half_pi},
      {"spot", spot(0.3F, 0.7F), 0.7},
      {"narrow spot", spot(0.05F, 0.2F), 0.2},
      {"spot of a half space", spot(0, half_pi), half_pi},
      {"spot with a short ramp", spot(0.4999F, 0.5F), 0.5},
      {"spot with a hard edge", spot(0.5F, 0.5F), 0.5}};
  const double level = statistics::sidak(1e-6, cases.size());
  for (const auto& [name, e, angle] : cases) {
    const statistics::ChiSquare result = directions(e, angle, e);
    EXPECT_GT(result.p, level) << name << ": " << result.message;
  }
  EXPECT_LT(directions(both, half_pi, emitter(Kind::area)).p, 1e-12) << "the test has no power";
}

// Near the axis a cosine has few values in float: squared sines must have more.
TEST(LightLeSample, ANarrowBeamHasNoRings) {
  Rng rng(35, 0, 0, Rng::Purpose::test);
  for (const float outer : {1e-2F, 1e-3F, 1e-4F}) {
    const EmitterPoint e = spot(0, outer);
    constexpr int cells = 200, draws = 200000;
    std::vector<double> observed(cells), expected(cells, double(draws) / cells);
    const double widest = std::sin(double(outer)) * std::sin(double(outer));
    for (int i = 0; i < draws; ++i) {
      const auto l = sample_Le(e, unit_box, rng);
      // Where the ramp ends, nothing shines.
      const double share = l ? V3d(l->ray.d).cross(V3d(e.ng)).length2() / widest : 0.9999;
      ++observed[static_cast<std::size_t>(std::min(share, 0.9999) * cells)];
    }
    const auto result = statistics::chi_square_test(observed, expected);
    EXPECT_GT(result.p, 1e-6) << outer << ": " << result.message;
  }
}

// The intensity at an angle to the axis, against the extension's formula in long double.
TEST(Spot, FollowsTheFormulaOfAnyCones) {
  for (double outer = 1.5; outer > 1e-5; outer /= 3) {
    for (const double share : {0.0, 0.5, 0.9, 0.99}) {
      const double inner = share * outer;
      const EmitterPoint e = spot(static_cast<float>(inner), static_cast<float>(outer));
      const V3d axis = V3d(e.ng).normalized();
      const V3d across = axis.cross(V3d(0, 0, 1)).normalized();
      for (double a = 0; a < 1.2 * outer; a += outer / 64) {
        const V3f w((axis * std::cos(a) + across * std::sin(a)).normalized());
        // The angle of the rounded direction to the rounded axis.
        const auto angle = static_cast<long double>(
            std::atan2(V3d(w).cross(V3d(e.ng)).length(), V3d(w).dot(V3d(e.ng))));
        const auto vers = [](long double x) { return 2 * std::sin(x / 2) * std::sin(x / 2); };
        const long double ramp = (vers(outer) - vers(angle)) / (vers(outer) - vers(inner));
        const auto bounded = static_cast<double>(std::clamp(ramp, 0.0L, 1.0L));
        // Roundings of the direction, as a share of the ramp.
        const double slack = 1e-6 + 4e-7 / (outer - inner);
        EXPECT_NEAR(double(e.towards(w).x), bounded * bounded, 2 * slack)
            << "cones " << inner << ", " << outer << "; angle " << a;
      }
    }
  }
}

TEST(Spot, HasAHardEdgeWhereBothConesAreOne) {
  for (const float outer : {1.5F, 0.5F, 1e-2F, 1e-4F}) {
    const EmitterPoint e = spot(outer, outer);
    const V3d axis = V3d(e.ng).normalized(), across = axis.cross(V3d(0, 0, 1)).normalized();
    for (const double share : {0.0, 0.5, 0.99, 1.01, 1.5}) {
      const double a = share * double(outer);
      const V3f w((axis * std::cos(a) + across * std::sin(a)).normalized());
      EXPECT_EQ(e.towards(w).x, share < 1 ? 1 : 0) << outer << ", " << share;
      EXPECT_EQ(e.pdf_Le(w).positive(), share < 1) << outer << ", " << share;
    }
  }
}

TEST(LightLeSample, CarriesTheEmissionOverBothDensities) {
  EmitterPoint both = emitter(Kind::area);
  both.both_sides = true;
  Rng rng(32, 0, 0, Rng::Purpose::test);
  for (const EmitterPoint& e :
       {emitter(Kind::area), both, emitter(Kind::point), spot(0.2F, 0.6F)}) {
    for (int i = 0; i < 1000; ++i) {
      const auto l = sample_Le(e, unit_box, rng);
      if (!l) continue;
      EXPECT_EQ(l->pdf.value, e.pdf_Le(l->ray.d).value);
      const float cosine = e.kind == Kind::area ? abs_dot(l->ray.d, e.ng) : 1;
      const Rgb expected = e.towards(l->ray.d) * cosine / (l->pdf.value * e.pdf.value);
      // The edge of a spot is as steep as the rounded direction lets it be known.
      const Rgb most = e.emission / (l->pdf.value * e.pdf.value);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(l->throughput[c], expected[c], 1e-5 * expected[c] + 1e-7 * most[c]);
      }
      EXPECT_LT((l->ray.o - e.x).length(), 1e-5);
      if (e.kind == Kind::area) {
        EXPECT_GT(dot(l->ray.o - e.x, e.ng) * dot(l->ray.d, e.ng), 0)
            << "starts on the wrong side of its own surface";
      }
    }
  }
}

// A spot's cone can be empty in floats: glTF allows any angle above 0.
TEST(LightLeSample, NothingLeavesAnEmptyCone) {
  Rng rng(33, 0, 0, Rng::Purpose::test);
  for (int i = 0; i < 20000; ++i) {
    const V2f u = rng.next2();
    const float z = 2 * u.x - 1, r = std::sqrt(1 - z * z);
    EmitterPoint e = emitter(Kind::spot, {r * std::cos(6.28F * u.y), r * std::sin(6.28F * u.y), z});
    e.ng = e.ng.normalized();  // its square may round to more than 1
    e.cones = SpotCones(0, 1e-30);
    EXPECT_FALSE(sample_Le(e, unit_box, rng));
    EXPECT_FALSE(e.pdf_Le(e.ng).positive());
  }
}

TEST(LightLeSample, NothingLeavesWhatIsNeverDrawn) {
  Rng rng(34, 0, 0, Rng::Purpose::test);
  for (const Kind kind :
       {Kind::area, Kind::point, Kind::spot, Kind::directional, Kind::environment}) {
    EmitterPoint e = emitter(kind);
    e.across = 1;
    EXPECT_TRUE(sample_Le(e, unit_box, rng));
    e.pdf = Pdf<Area>(0);
    EXPECT_FALSE(sample_Le(e, unit_box, rng));
    e = emitter(kind);
    e.across = 1;
    e.emission = Rgb(0, 0, 0);
    EXPECT_FALSE(sample_Le(e, unit_box, rng));
  }
}

}  // namespace
}  // namespace lacuna
