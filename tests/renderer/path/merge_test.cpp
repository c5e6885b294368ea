#include "renderer/path/merge.h"

#include <gtest/gtest.h>

#include "renderer/path/guide.h"

namespace lacuna {
namespace {

// On a curved mesh light may graze the triangle of the eye's vertex where it does not graze that of
// the photon: the quotient of the two cosines is no reason for a bright spot.
TEST(Merged, IsBoundedWhereLightGrazesTheEyesTriangle) {
  SurfaceParams grey;
  grey.base_color = Rgb(0.5F);
  grey.metallic = grey.transmission = grey.f90 = 0;
  grey.f0 = Rgb(0, 0, 0);
  const Lobes lobes(grey);
  Vertex v;
  v.kind = Vertex::Kind::surface;
  v.surface.ng = {0, 0, 1};
  v.surface.ns = V3f(0.7F, 0, 0.7F).normalized();
  v.wp = {0, 0, 1};
  v.bsdf.emplace(lobes, v.surface.ng, v.surface.ns);
  Photon p;
  p.ng = v.surface.ns;
  p.throughput = Rgb(1, 1, 1);
  const Guide guide;
  const SurfaceEndpoint eye{v, 1, Transport::radiance, guide};
  for (const float z : {1e-3F, 1e-6F}) {
    p.wp = V3f(1, 0, z).normalized();
    const Rgb value = merged(eye, p);
    EXPECT_GT(value.x, 0);
    EXPECT_LT(value.x, 1);  // 0.5 / pi times a quotient near 1
  }
  p.ng = v.surface.ng;  // as on a flat surface: the BSDF itself
  v.bsdf.emplace(lobes, v.surface.ng, v.surface.ng);
  for (const V3f& wp : {V3f(0, 0, 1), V3f(0.6F, 0, 0.8F)}) {
    p.wp = wp;
    EXPECT_NEAR(merged(eye, p).x, 0.5 / 3.14159265, 1e-6);
  }
}

}  // namespace
}  // namespace lacuna
