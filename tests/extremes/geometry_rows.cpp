// Light and eye nearly in the plane of a surface, and triangles that are hardly any.
#include <fmt/format.h>

#include "tests/extremes/rows.h"

namespace lacuna::extremes {
namespace {

/// In a furnace the answer is the same whatever its shape: flattened, all light grazes.
Row grazing(const std::string& name, const Furnace& f) {
  return {name, [=](Stage& stage, const Method& method, Check& check) {
            const std::string& scene = stage.scene(name, [&] { return furnace(f); });
            check_furnace(stage.render(stage.job(method, scene)), method, f, check);
          }};
}

Row cluttered(const std::string& name, Clutter clutter) {
  return {name, [=](Stage& stage, const Method& method, Check& check) {
            const std::string& scene =
                stage.scene(name, [&] { return room({.clutter = clutter}); });
            constexpr double rounding = 1e-5;
            check.same_picture(stage.render(stage.job(method, scene)), stage.plain(method), 1,
                               rounding);
          }};
}

}  // namespace

std::vector<Row> geometry_rows(const Effort&) {
  return {grazing("a room 1e-3 high", {.height = 1e-3}),
          grazing("a room 1e-5 high", {.height = 1e-5}),
          grazing("the eye 1e-4 off a wall", {.eye = 1e-4F}),
          grazing("the eye 1e-6 off a wall", {.eye = 1e-6F}),
          cluttered("triangles without area", Clutter::zero_area),
          cluttered("vertices there twice", Clutter::duplicated_vertices),
          cluttered("surfaces that coincide", Clutter::coincident),
          cluttered("needles", Clutter::needles)};
}

}  // namespace lacuna::extremes
