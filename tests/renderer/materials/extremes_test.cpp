// Nothing is ever NaN, infinite or negative: one test for each way to an edge.

#include <gtest/gtest.h>

#include "cases.h"

namespace lacuna {
namespace {

bool sound(const Rgb& c) { return is_finite(c) && c.x >= 0 && c.y >= 0 && c.z >= 0; }

/// All that a surface can be asked, for one pair of directions.
void check(const Bsdf& bsdf, const V3f& wo, const V3f& w, const V2f& u, float u_lobe) {
  for (const Transport transport : {Transport::radiance, Transport::importance}) {
    ASSERT_TRUE(sound(bsdf.eval(wo, w, transport))) << bsdf.eval(wo, w, transport);
    const float p = bsdf.pdf(wo, w, transport).value;
    ASSERT_TRUE(std::isfinite(p) && p >= 0) << p;
    const auto s = bsdf.sample(wo, u_lobe, u, transport);
    if (!s) continue;
    ASSERT_TRUE(sound(s->weight)) << s->weight;
    ASSERT_TRUE(is_finite(s->wi));
    ASSERT_NEAR(s->wi.length(), 1, 1e-5);
    ASSERT_TRUE(s->delta || (std::isfinite(s->pdf.value) && s->pdf.positive()));
  }
}

/// The corners of the unit interval as a generator can return them.
constexpr float last = 1 - 0x1p-24F;
constexpr std::array<float, 7> numbers{0, 0x1p-24F, 0.25F, 0.5F, 0.5F + 0x1p-23F, 0.75F, last};

void check_everywhere(const SurfaceParams& params, const std::vector<V3f>& directions,
                      const V3f& ng, const V3f& ns) {
  const Bsdf bsdf = cases::bsdf(params, ng, ns);
  ASSERT_TRUE(sound(bsdf.albedo()));
  for (const V3f& wo : directions) {
    for (const V3f& w : directions) {
      for (const float u : numbers) {
        check(bsdf, wo, w, {u, numbers[(&u - numbers.data() + 3) % numbers.size()]}, u);
        if (testing::Test::HasFatalFailure()) return;
      }
    }
  }
}

std::vector<V3f> ordinary_directions(const V3f& ng) {
  std::vector<V3f> result;
  for (const float cos : {1.0F, 0.6F, 0.05F, -0.3F, -0.9F})
    result.push_back(cases::direction(ng, cos, 2));
  return result;
}

const V3f z(0, 0, 1);
const V3f tilted_ns = V3f(0.6F, 0, 0.8F);

/// The disk's rim would be a direction along the surface, of density 0.
TEST(Extremes, DiskIsOpen) {
  for (const float x : numbers) {
    for (const float y : numbers) {
      const V2f d = sample_disk({x, y});
      EXPECT_GT(1 - d.x * d.x - d.y * d.y, 0) << x << " " << y;
      EXPECT_GT(dot(sample_cosine(tilted_ns, {x, y}), tilted_ns), 2e-4F) << x << " " << y;
    }
  }
}

TEST(Extremes, EverySurfaceAtEveryCornerOfTheRandomNumbers) {
  for (const cases::Surface& s : cases::surfaces()) {
    SCOPED_TRACE(s.name);
    check_everywhere(s.params, ordinary_directions(z), z, z);
    check_everywhere(s.params, ordinary_directions(z), z, tilted_ns);
  }
}

TEST(Extremes, GrazingAngles) {
  std::vector<V3f> grazing;
  for (const float cos : {1e-3F, 1e-5F, 1e-7F, 1e-12F, 1e-20F, 1e-30F, 1e-38F, 1e-42F, 0.0F}) {
    for (const float side : {1.0F, -1.0F}) {
      grazing.emplace_back(std::sqrt(1 - cos * cos), 0, side * cos);
      grazing.emplace_back(0, std::sqrt(1 - cos * cos), side * cos);
    }
  }
  grazing.push_back(z);
  for (const cases::Surface& s : cases::surfaces()) {
    SCOPED_TRACE(s.name);
    check_everywhere(s.params, grazing, z, z);
    check_everywhere(s.params, grazing, z, tilted_ns);
  }
}

TEST(Extremes, ShadingNormalInTheSurface) {
  const V3f flat_out(1, 0, 0);
  for (const cases::Surface& s : cases::surfaces()) {
    SCOPED_TRACE(s.name);
    check_everywhere(s.params, ordinary_directions(z), z, flat_out);
    check_everywhere(s.params, ordinary_directions(z), z, V3f(1, 0, 1e-20F));
    check_everywhere(s.params, {V3f(0, 1, 0), flat_out, -flat_out, z, -z}, z, flat_out);
  }
}

TEST(Extremes, OppositeAndEqualDirections) {
  const V3f w = V3f(0.3F, -0.2F, 0.5F).normalized();
  for (const cases::Surface& s : cases::surfaces()) {
    SCOPED_TRACE(s.name);
    check_everywhere(s.params, {w, -w, z, -z}, z, z);
  }
}

TEST(Extremes, AlphaFromSmoothTo1) {
  for (const float alpha :
       {0.0F, 1e-30F, 1e-5F, 0.9999F * ggx_min_alpha, ggx_min_alpha, 1e-3F, 1.0F}) {
    for (const float metallic : {0.0F, 0.5F, 1.0F}) {
      for (const float transmission : {0.0F, 0.5F, 1.0F}) {
        SurfaceParams p = cases::dielectric({0.9F, 0.5F, 0.1F}, alpha, 1.5F, transmission);
        p.metallic = metallic;
        check_everywhere(p, ordinary_directions(z), z, tilted_ns);
      }
    }
  }
}

TEST(Extremes, IndexFrom1ToEnormous) {
  for (const float ior : {1.0F, 1.0000001F, 1.0001F, 1.5F, 15.0F, 1e4F, 1e8F, 1e15F}) {
    for (const float alpha : {0.0F, ggx_min_alpha, 0.3F, 1.0F}) {
      SCOPED_TRACE(ior);
      check_everywhere(cases::dielectric({1, 1, 1}, alpha, ior, 1), ordinary_directions(z), z, z);
      check_everywhere(cases::dielectric({1, 1, 1}, alpha, ior, 0.5F), ordinary_directions(z), z,
                       tilted_ns);
    }
  }
}

TEST(Extremes, BaseColorBlackWhiteAndOneChannel) {
  for (const Rgb& base : {Rgb(0, 0, 0), Rgb(1, 1, 1), Rgb(0, 0, 1), Rgb(1e-38F, 0, 0)}) {
    for (const float transmission : {0.0F, 0.3F, 1.0F}) {
      for (const float f90 : {0.0F, 1e-30F, 1.0F}) {
        SurfaceParams p = cases::dielectric(base, 0.2F, 1.5F, transmission);
        p.f0 *= f90;
        p.f90 = f90;
        check_everywhere(p, ordinary_directions(z), z, tilted_ns);
        p.metallic = 0.5F;
        check_everywhere(p, ordinary_directions(z), z, tilted_ns);
      }
    }
  }
}

TEST(Extremes, LayerThatReflectsEverythingOrNearly) {
  for (const float f : {1.0F, 0.9999999F, 0.99F}) {
    for (const float alpha : {0.0F, 0.3F, 1.0F}) {
      SurfaceParams p = cases::layer(cases::lambert({1, 1, 1}), {f, f, f}, 1);
      p.alpha = alpha;
      check_everywhere(p, ordinary_directions(z), z, tilted_ns);
    }
  }
}

TEST(Extremes, RandomSurfacesAndDirections) {
  Rng random = cases::rng(1);
  const auto edge = [&] {
    const float u = random.next();
    return u < 0.2F ? 0.0F : u < 0.4F ? 1.0F : random.next();
  };
  for (int i = 0; i < 20000; ++i) {
    SurfaceParams p;
    p.base_color = Rgb(edge(), edge(), edge());
    p.metallic = edge();
    p.transmission = edge();
    p.alpha = std::pow(edge(), 4.0F);
    p.ior = 1 + std::pow(edge(), 3.0F) * 14;
    p.f90 = edge();
    p.f0 = p.f90 * Rgb(edge(), edge(), edge());
    const V3f ng = cases::uniform_direction(random).normalized();
    const V3f ns = random.next() < 0.3F ? ng : cases::uniform_direction(random).normalized();
    const Bsdf bsdf(p, ng, ns);
    const V3f wo = cases::uniform_direction(random), w = cases::uniform_direction(random);
    check(bsdf, wo, w, random.next2(), random.next());
    if (HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace lacuna
