// Directions follow the density that pdf() reports, and weights are eval / pdf.

#include <gtest/gtest.h>

#include "cases.h"
#include "tests/sphere_chi_square.h"

namespace lacuna {
namespace {

using cases::surfaces;
using cases::views;

/// A grid around the mirrored and the refracted direction for each normal that a sampler may use,
/// on either side of the surface.
class Regions {
 public:
  Regions(const SurfaceParams& p, const cases::View& v, Transport transport)
      : up_(dot(v.wo, v.ng) > 0 ? v.ng : -v.ng) {
    const bool front = dot(v.wo, v.ng) > 0;
    const V3f ns = front ? v.ns : -v.ns;
    const bool behind = dot(v.wo, ns) <= 0;
    if (p.coat_normal) {
      const V3f own = dot(*p.coat_normal, up_) > 0 ? *p.coat_normal : -*p.coat_normal;
      for (const V3f& n : {own, up_}) {
        if (dot(v.wo, n) > 0) add(p, v.wo, n, front);
      }
    }
    if (transport == Transport::radiance) {
      add(p, v.wo, behind || !mirror_stays(p, v.wo, ns) ? up_ : ns, front);
      return;
    }
    add(p, v.wo, behind ? up_ : ns, front);
    if (!behind && !v.flat()) add(p, v.wo, up_, front);
  }
  std::size_t operator()(const V3f& w) const {
    const std::size_t side = dot(w, up_) > 0 ? 0 : 1;
    std::size_t best = side;
    for (std::size_t i = side + 2; i < poles_.size(); i += 2) {
      if (dot(w, poles_[i]) > dot(w, poles_[best])) best = i;
    }
    return best;
  }
  std::span<const statistics::SphereGrid> grids() const { return grids_; }

 private:
  /// By `n`, an eye in direction `wo` sees a mirror image in front of the surface.
  bool mirror_stays(const SurfaceParams& p, const V3f& wo, const V3f& n) const {
    const bool opaque = (p.transmission + p.diffuse_transmission) * (1 - p.metallic) == 0;
    return !opaque || p.f90 + p.metallic == 0 || dot(reflect(wo, n), up_) > 0;
  }
  void add(const SurfaceParams& p, const V3f& wo, const V3f& n, bool front) {
    double width = p.f90 + p.metallic > 0 && p.alpha >= ggx_min_alpha ? p.alpha : 1.0F;
    if (p.coat > 0 && p.coat_alpha > 0) width = std::min(width, double(p.coat_alpha));
    if (p.coat_normal) width = std::min(width, double(std::max(p.coat_alpha, ggx_min_alpha)));
    const float index = cases::index_behind(p);
    const float eta = front ? index : 1 / index;
    const Fresnel f = fresnel_dielectric(dot(wo, n), eta);
    poles_.push_back(reflect(wo, n).normalized());
    // Beyond the critical angle only tilted facets refract, along the surface.
    poles_.push_back(f.total ? (dot(wo, n) * n - wo).normalized()
                             : refract(wo, n, eta, f.cos_t).normalized());
    grids_.emplace_back(poles_[poles_.size() - 2], width);
    // A tilted facet turns the refracted direction the less, the closer eta is to 1.
    const double turn = p.solid ? std::clamp(std::abs(eta - 1.0), 1e-3, 1.0) : 1.0;
    grids_.emplace_back(poles_.back(), width * turn);
  }

  V3f up_;
  std::vector<V3f> poles_;
  std::vector<statistics::SphereGrid> grids_;
};

class Sampling : public testing::TestWithParam<std::size_t> {
 protected:
  const cases::Surface surface_ = surfaces()[GetParam()];
};

/// A lobe seen at grazing angles is alpha cos high: of the size of the rounding of a direction, its
/// density cannot be known.
bool too_thin_for_floats(const SurfaceParams& p, const cases::View& v) {
  return p.alpha >= ggx_min_alpha && p.alpha * abs_dot(v.wo, v.ng) < 1e-6F;
}

/// The density of Ward's samples has the factor 1 / wo.m: the integral of a cell near its pole, at
/// grazing angles, is not known to the test.
bool has_pole(const SurfaceParams& p, const cases::View& v) {
  if (!p.exact || abs_dot(v.wo, v.ng) > 0.01F) return false;
  const FacetShape shape = p.exact->roughness.shape;
  return shape == FacetShape::ward || shape == FacetShape::ward_duer ||
         shape == FacetShape::ward_balanced;
}

constexpr Transport both_transports[] = {Transport::radiance, Transport::importance};

TEST_P(Sampling, FollowsPdf) {
  const double level = statistics::sidak(1e-3, surfaces().size() * views().size() * 2);
  std::uint64_t stream = GetParam() * 100;
  for (const cases::View& v : views()) {
    for (const Transport transport : both_transports) {
      if (transport == Transport::importance && v.flat() && surface_.reciprocal()) continue;
      if (too_thin_for_floats(surface_.params, v) || has_pole(surface_.params, v)) continue;
      SCOPED_TRACE(v.name + (transport == Transport::radiance ? " radiance" : " importance"));
      const Bsdf bsdf = cases::bsdf(surface_.params, v.ng, v.ns);
      Rng random = cases::rng(++stream);
      const auto draw = [&]() -> std::optional<V3f> {
        const auto s = cases::sample(bsdf, v.wo, random, transport);
        if (!s || s->delta) return std::nullopt;
        return s->wi;
      };
      const auto density = [&](const V3f& w) { return bsdf.pdf(v.wo, w, transport).value; };
      const Regions regions(surface_.params, v, transport);
      const auto result =
          statistics::sphere_chi_square(regions.grids(), regions, 20000, draw, density);
      EXPECT_GT(result.p, level) << result.message;
    }
  }
}

TEST_P(Sampling, WeightIsEvalOverPdf) {
  std::uint64_t stream = GetParam();
  for (const cases::View& v : views()) {
    SCOPED_TRACE(v.name);
    const Bsdf bsdf = cases::bsdf(surface_.params, v.ng, v.ns);
    Rng random = cases::rng(++stream);
    for (const Transport transport : both_transports) {
      for (int i = 0; i < 500; ++i) {
        const auto s = cases::sample(bsdf, v.wo, random, transport);
        if (!s) continue;
        EXPECT_EQ(s->transmitted, dot(s->wi, v.ng) * dot(v.wo, v.ng) < 0);
        EXPECT_NEAR(s->wi.length(), 1, 2e-6);
        if (s->delta) continue;
        ASSERT_TRUE(s->pdf.positive());
        ASSERT_EQ(s->pdf.value, bsdf.pdf(v.wo, s->wi, transport).value);
        const Rgb expected = bsdf.eval(v.wo, s->wi, transport) / s->pdf.value;
        const float rounding = 4e-7F * max_component(expected);
        ASSERT_LE(max_abs_component(s->weight - expected), rounding);
      }
    }
  }
}

/// A direction that pdf() never returns must not reflect either, or light is lost: checked in both
/// modes.
TEST_P(Sampling, CoversAllThatScatters) {
  std::uint64_t stream = GetParam();
  for (const cases::View& v : views()) {
    const Bsdf bsdf = cases::bsdf(surface_.params, v.ng, v.ns);
    Rng random = cases::rng(++stream);
    for (int i = 0; i < 2000; ++i) {
      const V3f wi = cases::uniform_direction(random);
      for (const Transport transport : both_transports) {
        if (bsdf.pdf(v.wo, wi, transport).positive()) continue;
        ASSERT_TRUE(is_black(bsdf.eval(v.wo, wi, transport))) << v.name;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Surfaces, Sampling, testing::Range(std::size_t{0}, surfaces().size()),
                         [](const auto& instance) { return surfaces()[instance.param].name; });

/// The harness itself: a density without its cosine, and a lobe one percent too wide, are caught.
TEST(SphereChiSquare, RejectsWrongDensities) {
  const cases::View v = views()[1];
  const auto p_value = [&](const SurfaceParams& params, const auto& density) {
    const Bsdf bsdf(params, v.ng, v.ns);
    Rng random = cases::rng(1);
    const auto draw = [&]() -> std::optional<V3f> {
      const auto s = cases::sample(bsdf, v.wo, random, Transport::radiance);
      return s ? std::optional(s->wi) : std::nullopt;
    };
    const Regions regions(params, v, Transport::radiance);
    return statistics::sphere_chi_square(regions.grids(), regions, 100000, draw, density).p;
  };
  const SurfaceParams diffuse = cases::lambert({1, 1, 1});
  const auto uniform = [&](const V3f& w) { return dot(w, v.ng) > 0 ? 0.5F * inv_pi : 0.0F; };
  EXPECT_LT(p_value(diffuse, uniform), 1e-9);
  const auto cosine = [&](const V3f& w) { return std::max(0.0F, dot(w, v.ng)) * inv_pi; };
  EXPECT_GT(p_value(diffuse, cosine), 1e-3);

  const SurfaceParams metal = cases::metal({1, 1, 1}, 0.1F);
  const Bsdf right(metal, v.ng, v.ns), wide(cases::metal({1, 1, 1}, 0.103F), v.ng, v.ns);
  EXPECT_LT(p_value(metal, [&](const V3f& w) { return wide.pdf(v.wo, w).value; }), 1e-6);
  EXPECT_GT(p_value(metal, [&](const V3f& w) { return right.pdf(v.wo, w).value; }), 1e-3);
  // A density that is right up to a factor leaves a wrong share for failures.
  EXPECT_LT(p_value(metal, [&](const V3f& w) { return 0.98F * right.pdf(v.wo, w).value; }), 1e-9);
  EXPECT_LT(p_value(metal, [&](const V3f& w) { return 1.02F * right.pdf(v.wo, w).value; }), 1e-9);
}

}  // namespace
}  // namespace lacuna
