// The lobes of glTF's extensions against the formulas of their texts, in double precision.

#include <gtest/gtest.h>

#include <numbers>

#include "cases.h"

namespace lacuna {
namespace {

constexpr double pi_d = std::numbers::pi;

/// The cosines of a pair of directions in the frame of the surface, where z is the normal.
struct Pair {
  Imath::V3d v, l, h;
  Pair(const V3f& wo, const V3f& wi) : v(wo), l(wi), h((v + l).normalized()) {}
};

double schlick(double f0, double cos) { return f0 + (1 - f0) * std::pow(1 - cos, 5); }

/// KHR_materials_anisotropy, D_GGX_Anisotropic and V_GGX_Anisotropic.
double ggx(const Pair& p, double at, double ab) {
  const double f = p.h.x * p.h.x / (at * at) + p.h.y * p.h.y / (ab * ab) + p.h.z * p.h.z;
  const double d = 1 / (pi_d * at * ab * f * f);
  const auto root = [&](const Imath::V3d& w) {
    return std::sqrt(at * at * w.x * w.x + ab * ab * w.y * w.y + w.z * w.z);
  };
  return d * 0.5 / (p.l.z * root(p.v) + p.v.z * root(p.l));
}

/// KHR_materials_sheen: the Charlie distribution and its visibility.
double charlie(const Pair& p, double alpha) {
  const double inv = 1 / alpha, sin2 = 1 - p.h.z * p.h.z;
  const double d = (2 + inv) * std::pow(sin2, inv / 2) / (2 * pi_d);
  const auto l = [alpha](double x) {
    const double t = (1 - alpha) * (1 - alpha);
    const auto mix = [t](double a, double b) { return b + (a - b) * t; };
    return mix(21.5473, 25.3245) /
               (1 + mix(3.82987, 3.32435) * std::pow(x, mix(0.19823, 0.16801))) +
           mix(-1.97760, -1.27393) * x + mix(-4.32054, -4.85967);
  };
  const auto lambda = [&](double cos) {
    return cos < 0.5 ? std::exp(l(cos)) : std::exp(2 * l(0.5) - l(1 - cos));
  };
  return d / ((1 + lambda(p.v.z) + lambda(p.l.z)) * 4 * p.v.z * p.l.z);
}

const V3f up(0, 0, 1);

Bsdf on_the_plane(const SurfaceParams& p) {
  Bsdf bsdf(p, up, up);
  bsdf.set_tangents({1, 0, 0}, {0, 1, 0});
  return bsdf;
}

V3f above(Rng& random) {
  const V3f w = cases::uniform_direction(random);
  return {w.x, w.y, std::max(std::abs(w.z), 0.02F)};
}

/// Calls `check(wo, wi, f)` for many directions above the plane; f without the cosine.
template <class Check>
void for_pairs(const SurfaceParams& params, bool other_side, Check&& check) {
  const Bsdf bsdf = on_the_plane(params);
  Rng random = cases::rng(1);
  for (int i = 0; i < 500; ++i) {
    const V3f wo = above(random).normalized(), wi = above(random).normalized();
    const V3f to = other_side ? V3f(wi.x, wi.y, -wi.z) : wi;
    const Rgb f = bsdf.eval(wo, to, Transport::radiance);
    check(wo, wi, V3d(f) / double(wi.z));
  }
}

TEST(Formulas, Anisotropy) {
  SurfaceParams p = cases::metal({0.8F, 0.5F, 0.2F}, 0.1F);
  p.alpha_along = 0.4F;
  for_pairs(p, false, [](const V3f& wo, const V3f& wi, const V3d& f) {
    const Pair pair(wo, wi);
    const double expected = ggx(pair, 0.4, 0.1) * schlick(0.5, pair.v.dot(pair.h));
    ASSERT_NEAR(f.y, expected, 1e-4 * expected + 1e-9);
  });
}

TEST(Formulas, RoughThinWall) {
  const SurfaceParams p = cases::thin(cases::dielectric({0.8F, 0.5F, 0.2F}, 0.3F, 1.5F, 1));
  for_pairs(p, true, [](const V3f& wo, const V3f& wi, const V3d& f) {
    // wi is the mirror image of the direction that light comes from.
    const Pair pair(wo, wi);
    const Fresnel fresnel = fresnel_dielectric(static_cast<float>(pair.v.dot(pair.h)), 1.5F);
    const double expected = (1 - double(fresnel.reflectance)) * 0.5 * ggx(pair, 0.3, 0.3);
    ASSERT_NEAR(f.y, expected, 2e-4 * expected + 1e-9);
  });
}

TEST(Formulas, DiffuseTransmission) {
  const SurfaceParams p = cases::leaf(cases::lambert({0.8F, 0.5F, 0.2F}), 0.4F);
  for_pairs(p, true,
            [](const V3f&, const V3f&, const V3d& f) { ASSERT_NEAR(f.y, 0.4 * 0.6 / pi_d, 1e-6); });
  for_pairs(p, false,
            [](const V3f&, const V3f&, const V3d& f) { ASSERT_NEAR(f.y, 0.6 * 0.5 / pi_d, 1e-6); });
}

/// Where nothing is bounded, at widths from .25 on.
TEST(Formulas, Sheen) {
  const SurfaceParams p = cases::cloth(cases::lambert({0, 0, 0}), {0.9F, 0.6F, 0.3F}, 0.36F);
  for_pairs(p, false, [](const V3f& wo, const V3f& wi, const V3d& f) {
    const Pair pair(wo, wi);
    const double expected = 0.6 * charlie(pair, 0.36);
    ASSERT_NEAR(f.y, expected, 1e-3 * expected + 1e-6);
  });
}

/// The text's scaling: 1 less the largest channel times the larger albedo of both directions.
TEST(Formulas, BaseBelowSheen) {
  const auto albedo = [](double cos) {
    constexpr int n = 200;
    double sum = 0;
    const V3f wo(static_cast<float>(std::sqrt(1 - cos * cos)), 0, static_cast<float>(cos));
    for (int i = 0; i < n; ++i) {
      const double cos_l = (i + 0.5) / n, r = std::sqrt(1 - cos_l * cos_l);
      for (int k = 0; k < n; ++k) {
        const double phi = pi_d * (k + 0.5) / n;
        const Pair pair(wo, V3f(V3d(r * std::cos(phi), r * std::sin(phi), cos_l)));
        sum += charlie(pair, 0.36) * cos_l;
      }
    }
    return sum * 2 * pi_d / (n * n);
  };
  const SurfaceParams white = cases::cloth(cases::lambert({1, 1, 1}), {0.9F, 0.6F, 0.3F}, 0.36F);
  const Bsdf bsdf = on_the_plane(white);
  for (const float cos_o : {0.9F, 0.3F, 0.1F}) {
    for (const float cos_i : {0.8F, 0.2F}) {
      const V3f wo = cases::direction(up, cos_o, 0), wi = cases::direction(up, cos_i, 2);
      const double f = double(bsdf.eval(wo, wi, Transport::radiance).y) / double(cos_i);
      const double scale = 1 - 0.9 * std::max(albedo(double(cos_o)), albedo(double(cos_i)));
      EXPECT_NEAR(f, 0.6 * charlie(Pair(wo, wi), 0.36) + scale / pi_d, 2e-3);
    }
  }
}

/// The coat's own lobe over a black base, and at normal incidence the share that reaches the base.
TEST(Formulas, ClearCoat) {
  const SurfaceParams black = cases::coated(cases::lambert({0, 0, 0}), 0.8F, 0.2F);
  for_pairs(black, false, [](const V3f& wo, const V3f& wi, const V3d& f) {
    const Pair pair(wo, wi);
    const double expected = 0.8 * schlick(0.04, pair.v.dot(pair.h)) * ggx(pair, 0.2, 0.2);
    ASSERT_NEAR(f.y, expected, 1e-4 * expected + 1e-9);
  });
  const Bsdf bsdf = on_the_plane(cases::coated(cases::lambert({1, 1, 1}), 0.8F, 0));
  const V3f grazing = cases::direction(up, 0.3F, 1);
  const double most = 1 - 0.8 * schlick(0.04, 0.3);
  EXPECT_NEAR(double(bsdf.eval(up, grazing, Transport::radiance).x), most * 0.3 / pi_d, 1e-5);
  EXPECT_NEAR(double(bsdf.eval(grazing, up, Transport::radiance).x), most / pi_d, 1e-5);
}

/// Over black, both smooth lobes are the coat's; over a mirror they add up to 1.
TEST(Formulas, SmoothCoatOverAMirrorLosesNothing) {
  const Bsdf bsdf = on_the_plane(cases::coated(cases::metal({1, 1, 1}, 0), 1, 0));
  for (const float cos : {1.0F, 0.5F, 0.1F}) {
    const auto lobe = bsdf.delta(cases::direction(up, cos, 1), false);
    ASSERT_TRUE(lobe);
    EXPECT_NEAR(lobe->value.x, 1, 1e-6) << cos;
    EXPECT_NEAR(lobe->p_radiance, 1, 1e-6) << cos;
  }
}

/// A film on a dielectric for one wavelength: Airy's formula for the amplitudes of both
/// polarisations, summed over all orders.
double airy(double cos, double film, double base, double opd_over_wavelength) {
  const auto inside = [&](double n) { return std::sqrt(1 - (1 - cos * cos) / (n * n)); };
  const double c1 = cos, c2 = inside(film), c3 = inside(base);
  double sum = 0;
  for (const bool parallel : {false, true}) {
    const auto amplitude = [&](double n1, double a1, double n2, double a2) {
      return parallel ? (n2 * a1 - n1 * a2) / (n2 * a1 + n1 * a2)
                      : (n1 * a1 - n2 * a2) / (n1 * a1 + n2 * a2);
    };
    const double r12 = amplitude(1, c1, film, c2), r23 = amplitude(film, c2, base, c3);
    const double c = std::cos(2 * pi_d * opd_over_wavelength);
    sum += (r12 * r12 + r23 * r23 + 2 * r12 * r23 * c) /
           (1 + r12 * r12 * r23 * r23 + 2 * r12 * r23 * c);
  }
  return sum / 2;
}

/// Reflectance over the spectrum, seen by a fit of the CIE's 1931 observer (Wyman, Sloan and
/// Shirley 2013, "Simple Analytic Approximations to the CIE XYZ Color Matching Functions"),
/// relative to a white of equal energy. The extension's Gaussians are another fit, its Fresnel
/// terms are Schlick's, and it stops at the second order.
V3d spectral_film(double cos, double film, double base, double thickness) {
  V3d xyz(0), white(0);
  const auto g = [](double x, double mean, double low, double high) {
    const double t = (x - mean) * (x < mean ? low : high);
    return std::exp(-t * t / 2);
  };
  const double path = 2 * film * thickness * std::sqrt(1 - (1 - cos * cos) / (film * film));
  for (double nm = 380; nm <= 780; nm += 2) {
    const V3d observer(1.056 * g(nm, 599.8, 0.0264, 0.0323) + 0.362 * g(nm, 442, 0.0624, 0.0374) -
                           0.065 * g(nm, 501.1, 0.049, 0.0382),
                       0.821 * g(nm, 568.8, 0.0213, 0.0247) + 0.286 * g(nm, 530.9, 0.0613, 0.0322),
                       1.217 * g(nm, 437, 0.0845, 0.0278) + 0.681 * g(nm, 459, 0.0385, 0.0725));
    xyz += observer * airy(cos, film, base, path / nm);
    white += observer;
  }
  const V3d n(xyz.x / white.x, xyz.y / white.y, xyz.z / white.z);
  return {3.2404542 * n.x - 1.5371385 * n.y - 0.4985314 * n.z,
          -0.9692660 * n.x + 1.8760108 * n.y + 0.0415560 * n.z,
          0.0556434 * n.x - 0.2040259 * n.y + 1.0572252 * n.z};
}

TEST(Formulas, FilmHasTheColoursOfTheSpectrum) {
  for (const float thickness : {150.0F, 300.0F, 450.0F}) {
    for (const float cos : {1.0F, 0.6F}) {
      const ThinFilm film{1, 1.8F, thickness};
      const float f0 = normal_reflectance(1.5F);
      const Rgb found = film.reflectance(cos, Rgb(f0));
      const V3d expected = spectral_film(double(cos), 1.8, 1.5, double(thickness));
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(double(found[c]), expected[c], 0.06)
            << thickness << " nm, " << cos << ", " << c;
      }
    }
  }
  // Without a film the base is left, but for what the text bounds its series by.
  EXPECT_NEAR(ThinFilm({1, 1.8F, 0}).reflectance(1, Rgb(0.04F)).x, 0.04, 0.01);
}

}  // namespace
}  // namespace lacuna
