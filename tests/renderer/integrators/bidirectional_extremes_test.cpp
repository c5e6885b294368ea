// Light tracing and every choice of connections where something is least, most, or missing.

#include <gtest/gtest.h>

#include "renderer/gltf/gltf_load.h"
#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/same_picture.h"
#include "tests/renderer/scene/scene_parts.h"

namespace lacuna {
namespace {

using test::expect_same_picture;
using test::Method;
using test::Rendering;
using test::RenderSettings;
using test::SceneParts;

std::vector<Method> with_light(std::vector<Method> methods, int max_depth) {
  methods.push_back({"light", test::light_tracing(max_depth)});
  return methods;
}

RenderSettings small(const IntegratorSettings& integrator, int iterations) {
  return {.integrator = integrator, .width = 12, .height = 10, .iterations = iterations};
}

Rendering by_path(SceneData data, int max_depth, int iterations, bool nee = true) {
  PathSettings path = test::path_tracing(max_depth);
  path.next_event_estimation = nee;
  RenderSettings s = small(path, iterations);
  s.seed = 2;
  return render(std::move(data), s);
}

void expect_black(const Rendering& r) {
  for (const double v : r.film.mean()) EXPECT_EQ(v, 0);
  EXPECT_EQ(r.counters.rejected, 0U);
}

/// A closed room of 2 by 2 by 2 around the origin, of one material, with its eye.
SceneParts closed_room(const Material& wall) {
  SceneParts p;
  p.box({-1, -1, -1}, {1, 1, 1}, false, p.material(wall));
  p.eye({0.1, 0.2, 0.9}, {0, 0, -1}, 1.4);
  return p;
}
const Material grey = test::diffuse(Rgb(0.6F, 0.5F, 0.4F));

/// A lamp under the ceiling of a room around `centre`, facing down.
void add_lamp(SceneParts& p, const V3f& centre, const Rgb& radiance) {
  p.quad(centre + V3f(-0.4F, 0.95F, -0.4F), {0.8F, 0, 0}, {0, 0, 0.8F},
         p.material(test::lamp(radiance)));
}

SceneData lamp_room() {
  SceneParts p = closed_room(grey);
  add_lamp(p, V3f(0, 0, 0), Rgb(3, 4, 5));
  return std::move(p.data);
}

TEST(BidirectionalExtremes, Depths) {
  for (const int depth : {1, 2, 64}) {
    const Rendering expected = by_path(lamp_room(), depth, 600);
    for (const Method& m : with_light(test::connections(depth), depth)) {
      SCOPED_TRACE(testing::Message() << m << ", depth " << depth);
      const int iterations = depth < 64 ? 100 : 20;
      expect_same_picture(render(lamp_room(), small(m.settings, iterations)), expected, 0.05);
    }
  }
}

TEST(BidirectionalExtremes, OneLightPath) {
  const Rendering expected = by_path(lamp_room(), 4, 1000);
  for (const Method& m : test::connections(4, 1)) {
    SCOPED_TRACE(m);
    expect_same_picture(render(lamp_room(), small(m.settings, 500)), expected, 0.05);
  }
  SCOPED_TRACE("light");
  expect_same_picture(render(lamp_room(), small(test::light_tracing(4, 1), 8000)), expected, 0.07);
}

TEST(LongBidirectionalExtremes, MoreLightPathsThanPixels) {
  const Rendering expected = by_path(lamp_room(), 4, 1000);
  for (const Method& m : test::connections(4, 1000)) {
    SCOPED_TRACE(m);
    expect_same_picture(render(lamp_room(), small(m.settings, 60)), expected, 0.03);
  }
}

TEST(BidirectionalExtremes, OnePixel) {
  RenderSettings s = small(test::path_tracing(4), 30000);
  s.width = s.height = 1;
  const Rendering expected = render(lamp_room(), s);
  for (const Method& m : with_light(test::connections(4, 20), 4)) {
    SCOPED_TRACE(m);
    s.integrator = m.settings;
    s.iterations = 2000;
    s.seed = 3;
    expect_same_picture(render(lamp_room(), s), expected, 0.07);
  }
}

/// Two halves of a room, seen from above the wall between them. In each a lamp shines on the
/// ceiling, and what the eye sees of a half is lit from the ceiling above it.
SceneData two_halves() {
  SceneParts p;
  const auto wall = p.material(grey);
  p.box({-1, -1, -1}, {1, 1, 1}, false, wall);
  p.box({-0.02F, -1, -1}, {0.02F, 0.2F, 1}, true, wall);
  const auto shine = p.material(test::lamp(Rgb(300, 400, 500)));
  for (const float x : {-0.55F, 0.45F}) p.quad({x, 0.8F, -0.3F}, {0, 0, 0.1F}, {0.1F, 0, 0}, shine);
  p.eye({0, 0.35, 0.2}, {0, -1, -0.2}, 1.2);
  return std::move(p.data);
}

// One pixel has the whole view. Which half its eye path goes to tells nothing of the lamp that its
// light path starts at.
TEST(LongBidirectionalExtremes, PathsThatMeetAreIndependent) {
  RenderSettings s = small(test::path_tracing(3), 300000);
  s.width = s.height = 1;
  const Rendering expected = render(two_halves(), s);
  for (const Method& m : test::connections(3, 20)) {
    SCOPED_TRACE(m);
    s.integrator = m.settings;
    s.iterations = 8000;
    s.seed = 3;
    expect_same_picture(render(two_halves(), s), expected, 0.03);
  }
}

TEST(BidirectionalExtremes, NoLightAtAll) {
  for (const Method& m : with_light(test::connections(5), 5)) {
    SCOPED_TRACE(m);
    expect_black(render(std::move(closed_room(grey).data), small(m.settings, 3)));
    expect_black(test::render("open.glb", small(m.settings, 3)));
  }
}

// All light paths stay outside.
TEST(LongBidirectionalExtremes, LightThatNeverReachesTheRoom) {
  const auto outside = [](bool lit) {
    SceneParts p = closed_room(grey);
    p.box({4, -1, -1}, {6, 1, 1}, false, p.material(grey));
    add_lamp(p, V3f(5, 0, 0), Rgb(80));
    if (lit) add_lamp(p, V3f(0, 0, 0), Rgb(3, 4, 5));
    return std::move(p.data);
  };
  const Rendering expected = by_path(lamp_room(), 4, 1000);
  for (const Method& m : with_light(test::connections(4), 4)) {
    SCOPED_TRACE(m);
    expect_black(render(outside(false), small(m.settings, 4)));
    expect_same_picture(render(outside(true), small(m.settings, 500)), expected, 0.06);
  }
}

TEST(LongBidirectionalExtremes, BrightAndDimTogether) {
  const auto both = [](float bright, float dim, bool apart) {
    SceneParts p = closed_room(grey);
    p.box({4, -1, -1}, {6, 1, 1}, false, p.material(grey));
    add_lamp(p, V3f(apart ? 5.0F : 0.0F, 0, 0), Rgb(bright));
    p.quad({-0.9F, -0.5F, -0.5F}, {0, 0.5F, 0}, {0, 0, 0.5F}, p.material(test::lamp(Rgb(dim))));
    return std::move(p.data);
  };
  const Rendering bright = by_path(both(1e12F, 0, false), 4, 1000);
  // Behind the wall the bright one takes every draw: the dim one is found by chance alone.
  const Rendering dim = by_path(both(0, 1e-12F, true), 4, 2000, false);
  for (const Method& m : with_light(test::connections(4), 4)) {
    SCOPED_TRACE(m);
    expect_same_picture(render(both(1e12F, 1e-12F, false), small(m.settings, 200)), bright, 0.03);
    const Rendering apart = render(both(1e12F, 1e-12F, true), small(m.settings, 400));
    EXPECT_EQ(apart.counters.rejected, 0U);
    if (m.name != "light") expect_same_picture(apart, dim, 0.08);
  }
}

TEST(BidirectionalExtremes, EverythingSpecular) {
  for (const Material& wall : {test::metal(Rgb(0.8F, 0.7F, 0.6F), 0), test::glass()}) {
    const auto mirrors = [&] {
      SceneParts p = closed_room(wall);
      add_lamp(p, V3f(0, 0, 0), Rgb(3, 4, 5));
      return std::move(p.data);
    };
    const Rendering expected = by_path(mirrors(), 6, 1000);
    for (const Method& m : test::connections(6)) {
      SCOPED_TRACE(m);
      expect_same_picture(render(mirrors(), small(m.settings, 300)), expected, 0.02);
    }
    // Nothing of a surface that only reflects can be joined to the eye: what is left is the lamp.
    SCOPED_TRACE("light");
    expect_same_picture(render(mirrors(), small(test::light_tracing(6), 300)),
                        by_path(mirrors(), 1, 1000), 0.02);
  }
}

// What a mask takes away is not there, and does not shine.
TEST(LongBidirectionalExtremes, MaskedEmitters) {
  const auto hidden = [] {
    SceneParts p = closed_room(grey);
    Material lamp = test::lamp(Rgb(5, 5, 5));
    lamp.mask = true;
    lamp.alpha = 0.2F;
    p.quad({-0.5F, 0.9F, -0.5F}, {1, 0, 0}, {0, 0, 1}, p.material(lamp));
    return std::move(p.data);
  };
  const auto grille = [] {  // bars and gaps
    SceneData data = load_gltf(test::own_scene("sides.glb"));
    for (Material& m : data.materials) {
      m.emission = m.mask ? Rgb(4, 4, 4) : Rgb(0, 0, 0);
      if (!m.mask) m.base_color = Rgb(0.8F);
    }
    return data;
  };
  expect_black(by_path(hidden(), 4, 4));
  const Rendering expected = by_path(grille(), 4, 4000, false);
  std::vector<Method> methods = with_light(test::connections(4), 4);
  methods.push_back({"path", test::path_tracing(4)});
  for (const Method& m : methods) {
    SCOPED_TRACE(m);
    expect_black(render(hidden(), small(m.settings, 4)));
    expect_same_picture(render(grille(), small(m.settings, 1000)), expected, 0.05);
  }
}

}  // namespace
}  // namespace lacuna
