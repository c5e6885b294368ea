// Means of a sphere under simple light against values of Mitsuba 0.6 (RGB build, single precision):
// an independent implementation of the surfaces of LACUNA_materials.

#include <gtest/gtest.h>

#include <cmath>

#include "cases.h"

namespace lacuna {
namespace {

/// The means of pictures of a unit sphere, seen from far along z, over its disc, with the standard
/// errors of their worst channel.
struct PublishedMean {
  std::string name;
  SurfaceParams params;
  Rgb furnace;  ///< under radiance 1 from everywhere
  float furnace_error;
  Rgb lobe;  ///< under a point light of 20 W/sr at (2, 3, 4)
  float lobe_error;
};

std::vector<PublishedMean> published_opaque() {
  using namespace cases;
  const Rgb half(0.5F, 0.5F, 0.5F);
  const SurfaceParams gold = exact({.base = ExactSurface::Base::conductor,
                                    .eta = {0.143124F, 0.374956F, 1.442476F},
                                    .k = {3.983154F, 2.385723F, 1.603208F}});
  return {
      {"roughdiffuse_0_3",
       exact({.base = ExactSurface::Base::diffuse, .sigma = 0.3F / 1.41421356F}, half),
       {0.485541F, 0.485541F, 0.485541F},
       3.8e-05F,
       {0.063413F, 0.063413F, 0.063413F},
       3.9e-06F},
      {"conductor_etak",
       metal_of({}),
       {0.916219F, 0.908018F, 0.912040F},
       1.0e-05F,
       {0.000000F, 0.000000F, 0.000000F},
       0.0e+00F},
      {"conductor_Au",
       gold,
       {0.964566F, 0.809651F, 0.367733F},
       2.6e-05F,
       {0.000000F, 0.000000F, 0.000000F},
       0.0e+00F},
      {"roughconductor_ggx_0_05",
       metal_of(facets(0.05F)),
       {0.908791F, 0.900282F, 0.904015F},
       1.2e-04F,
       {0.060533F, 0.059865F, 0.059938F},
       4.8e-05F},
      {"roughconductor_ggx_0_2",
       metal_of(facets(0.2F)),
       {0.840766F, 0.832009F, 0.834501F},
       1.9e-04F,
       {0.062760F, 0.062068F, 0.062143F},
       9.9e-06F},
      {"roughconductor_ggx_0_5",
       metal_of(facets(0.5F)),
       {0.636555F, 0.629613F, 0.630918F},
       1.3e-04F,
       {0.060461F, 0.059794F, 0.059867F},
       2.9e-06F},
      {"roughconductor_beckmann_0_05",
       metal_of(facets(0.05F, FacetShape::beckmann)),
       {0.915205F, 0.906902F, 0.910869F},
       4.3e-05F,
       {0.060211F, 0.059547F, 0.059619F},
       5.3e-05F},
      {"roughconductor_beckmann_0_2",
       metal_of(facets(0.2F, FacetShape::beckmann)),
       {0.900919F, 0.891899F, 0.895098F},
       1.3e-04F,
       {0.061202F, 0.060527F, 0.060600F},
       1.3e-05F},
      {"roughconductor_beckmann_0_5",
       metal_of(facets(0.5F, FacetShape::beckmann)),
       {0.822970F, 0.814109F, 0.816092F},
       1.5e-04F,
       {0.065819F, 0.065093F, 0.065172F},
       3.2e-06F},
      {"roughconductor_ggx_0_1_0_4",
       metal_of({{0.1F, 0.4F}}),
       {0.784223F, 0.775722F, 0.777382F},
       1.9e-04F,
       {0.068741F, 0.067983F, 0.068065F},
       1.6e-05F},
      {"plastic_1_5_linear",
       plastic_of({}, false),
       {0.636664F, 0.364233F, 0.182612F},
       8.8e-05F,
       {0.071789F, 0.035895F, 0.011965F},
       3.2e-06F},
      {"plastic_1_5_nonlinear",
       plastic_of({}, true),
       {0.434279F, 0.225730F, 0.130782F},
       9.3e-05F,
       {0.045124F, 0.017646F, 0.005136F},
       2.0e-06F},
      {"roughplastic_ggx_0_1_linear",
       plastic_of(facets(0.1F), false),
       {0.628031F, 0.352983F, 0.169617F},
       8.2e-05F,
       {0.074564F, 0.038622F, 0.014660F},
       3.6e-06F},
      {"roughplastic_ggx_0_3_linear",
       plastic_of(facets(0.3F), false),
       {0.598103F, 0.325851F, 0.144350F},
       6.7e-05F,
       {0.073508F, 0.038135F, 0.014554F},
       3.5e-06F},
      {"roughplastic_ggx_0_1_nonlinear",
       plastic_of(facets(0.1F), true),
       {0.424026F, 0.213323F, 0.117346F},
       8.6e-05F,
       {0.047905F, 0.020371F, 0.007829F},
       2.5e-06F},
      {"roughplastic_ggx_0_3_nonlinear",
       plastic_of(facets(0.3F), true),
       {0.394852F, 0.186905F, 0.092380F},
       7.1e-05F,
       {0.047101F, 0.020083F, 0.007801F},
       2.2e-06F},
      {"phong_30",
       phong_of(30),
       {0.667374F, 0.667374F, 0.667374F},
       1.2e-04F,
       {0.074959F, 0.074959F, 0.074959F},
       1.0e-05F},
      {"ward_0_15_ward",
       glossy_of(facets(0.15F, FacetShape::ward)),
       {0.652930F, 0.652930F, 0.652930F},
       1.1e-04F,
       {0.073399F, 0.073399F, 0.073399F},
       8.4e-06F},
      {"ward_0_15_ward_duer",
       glossy_of(facets(0.15F, FacetShape::ward_duer)),
       {0.783311F, 0.783311F, 0.783311F},
       1.7e-04F,
       {0.075674F, 0.075674F, 0.075674F},
       9.0e-06F},
      {"ward_0_15_balanced",
       glossy_of(facets(0.15F, FacetShape::ward_balanced)),
       {0.779142F, 0.779142F, 0.779142F},
       1.6e-04F,
       {0.076168F, 0.076168F, 0.076168F},
       9.0e-06F},
      {"coating_diffuse",
       coated_with(lambert(half), {}, Rgb(0, 0, 0)),
       {0.274897F, 0.274897F, 0.274897F},
       1.6e-04F,
       {0.024148F, 0.024148F, 0.024148F},
       1.1e-06F},
      {"coating_sigma_diffuse",
       coated_with(lambert(half), {}, {0.1F, 0.3F, 0.6F}),
       {0.237706F, 0.184404F, 0.138677F},
       1.3e-04F,
       {0.019318F, 0.012368F, 0.006342F},
       8.5e-07F},
      {"roughcoating_ggx_0_1_roughconductor",
       coated_with(metal_of(facets(0.3F)), facets(0.1F), Rgb(0, 0, 0)),
       {0.479413F, 0.474981F, 0.475466F},
       2.2e-04F,
       {0.043915F, 0.043461F, 0.043509F},
       2.8e-06F},
  };
}

/// After at most 11 scattering events on paths through the sphere.
std::vector<PublishedMean> published_glass() {
  using namespace cases;
  return {
      {"dielectric_1_5",
       glass_of(1.5F, {}),
       {0.999888F, 0.999888F, 0.999888F},
       6.3e-06F,
       Rgb(0, 0, 0),
       0},
      {"thindielectric_1_5",
       exact({.base = ExactSurface::Base::thin_dielectric}),
       {0.999681F, 0.999681F, 0.999681F},
       8.9e-06F,
       Rgb(0, 0, 0),
       0},
      {"roughdielectric_ggx_0_2",
       glass_of(1.5F, facets(0.2F)),
       {0.827496F, 0.827496F, 0.827496F},
       2.0e-04F,
       Rgb(0, 0, 0),
       0},
      {"roughdielectric_beckmann_0_2",
       glass_of(1.5F, facets(0.2F, FacetShape::beckmann)),
       {0.931234F, 0.931234F, 0.931234F},
       1.6e-04F,
       Rgb(0, 0, 0),
       0},
  };
}

const V3f to_eye(0, 0, 1);

/// The BSDF at the point of the sphere at unit `n`, with u along the azimuth around z.
Bsdf on_sphere(const SurfaceParams& params, const V3f& n) {
  Bsdf result(params, n, n);
  const V3f along = cross(to_eye, n);
  if (along.length2() > 0) {
    const V3f u = along.normalized();
    result.set_tangents(u, cross(n, u));
  }
  return result;
}

/// The point of the sphere seen at a point of its disc, whose area is preserved; `u` in [0, 1)^2.
V3f seen_point(const V2f& u) {
  const float r2 = u.x, phi = 2 * pi * u.y;
  return {std::sqrt(r2) * std::cos(phi), std::sqrt(r2) * std::sin(phi), std::sqrt(1 - r2)};
}

/// Point `i` of an additive recurrence in five dimensions (Roberts 2018): evenly spread.
std::array<float, 5> spread_point(std::uint64_t i) {
  constexpr double g = 1.1347241384015194;  // g^6 = g + 1
  std::array<float, 5> x;
  double step = 1;
  for (float& k : x) {
    step /= g;
    const double t = 0.5 + static_cast<double>(i) * step;
    k = std::min(static_cast<float>(t - std::floor(t)), 0x1.fffffep-1F);
  }
  return x;
}

/// What the sphere's surface sends to the eye from light 1 all around: the weight of one sample at
/// each of many points.
Rgb furnace_mean(const SurfaceParams& params) {
  constexpr std::uint64_t n = 200000;
  V3d sum(0, 0, 0);
  for (std::uint64_t i = 0; i < n; ++i) {
    const auto u = spread_point(i);
    const Bsdf bsdf = on_sphere(params, seen_point({u[0], u[1]}));
    const auto s = bsdf.sample(to_eye, double(u[2]), {u[3], u[4]}, Transport::radiance);
    if (s) sum += V3d(s->weight);
  }
  return Rgb(V3f(sum / double(n)));
}

/// By the midpoint rule.
Rgb lobe_mean(const SurfaceParams& params) {
  constexpr int n = 600;
  const V3f light(2, 3, 4);
  V3d sum(0, 0, 0);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const V2f u((static_cast<float>(i) + 0.5F) / n, (static_cast<float>(j) + 0.5F) / n);
      const V3f x = seen_point(u), to_light = light - x;
      const Rgb f = on_sphere(params, x).eval(to_eye, to_light.normalized(), Transport::radiance);
      sum += V3d(f * (20 / to_light.length2()));
    }
  }
  return Rgb(V3f(sum / double(n * n)));
}

/// Paths that enter the sphere and leave it again.
Rgb glass_furnace_mean(const SurfaceParams& params) {
  constexpr int n = 100000, most_events = 11;
  V3d sum(0, 0, 0);
  for (int i = 0; i < n; ++i) {
    const auto u = spread_point(static_cast<std::uint64_t>(i));
    Rng random = cases::rng(static_cast<std::uint64_t>(i));
    V3f x = seen_point({u[0], u[1]}), w = to_eye;  // to where the light goes
    Rgb throughput(1, 1, 1);
    for (int event = 0; event < most_events; ++event) {
      const auto s = cases::sample(Bsdf(params, x, x), w, random, Transport::radiance);
      if (!s) break;
      throughput *= s->weight;
      if (dot(s->wi, x) > 0) {
        sum += V3d(throughput);
        break;
      }
      x = (x - 2 * dot(s->wi, x) * s->wi).normalized();
      w = -s->wi;
    }
  }
  return Rgb(V3f(sum / double(n)));
}

/// `tolerance`: relative, of both numbers' methods.
void expect_published(const Rgb& found, const Rgb& published, float error, float tolerance) {
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(found[c], published[c], 4 * error + tolerance * published[c]) << "channel " << c;
  }
}

void PrintTo(const PublishedMean& mean, std::ostream* out) { *out << mean.name; }

class Published : public testing::TestWithParam<PublishedMean> {};

/// Mitsuba reads what a rough interface transmits from a coarse table of its own.
float tolerance_of(const PublishedMean& mean) {
  const auto& coating = mean.params.exact->coating;
  const bool plastic = mean.params.exact->base == ExactSurface::Base::plastic;
  const bool tabulated = (plastic && mean.params.exact->roughness.widths().x > 0) ||
                         (coating && coating->roughness.widths().x > 0);
  return tabulated ? 5e-3F : 1e-3F;
}

TEST_P(Published, Furnace) {
  expect_published(furnace_mean(GetParam().params), GetParam().furnace, GetParam().furnace_error,
                   tolerance_of(GetParam()));
}
TEST_P(Published, PointLight) {
  expect_published(lobe_mean(GetParam().params), GetParam().lobe, GetParam().lobe_error,
                   tolerance_of(GetParam()));
}
INSTANTIATE_TEST_SUITE_P(Opaque, Published, testing::ValuesIn(published_opaque()),
                         [](const auto& i) { return i.param.name; });

class PublishedGlass : public testing::TestWithParam<PublishedMean> {};

TEST_P(PublishedGlass, Furnace) {
  expect_published(glass_furnace_mean(GetParam().params), GetParam().furnace,
                   GetParam().furnace_error, 1e-3F);
}
INSTANTIATE_TEST_SUITE_P(Glass, PublishedGlass, testing::ValuesIn(published_glass()),
                         [](const auto& i) { return i.param.name; });

}  // namespace
}  // namespace lacuna
