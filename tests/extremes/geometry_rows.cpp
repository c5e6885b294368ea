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

/// Rays start off the floor by what is rounded where they start, whatever its size: the block that
/// stands on it keeps its shadow.
Row on_a_floor(double half_side) {
  return {fmt::format("a block of .1 on a floor of {:g}", 2 * half_side),
          [=](Stage& stage, const Method& method, Check& check) {
            constexpr double room = 64;  // what lies further away gives no light here
            const auto on = [&](double half) {
              const std::string name = fmt::format("block-on-{:g}", half);
              return stage.render(
                  stage.job(method, stage.scene(name, [=] { return block_on_floor(half); })));
            };
            constexpr double rounding = 1e-4;
            check.same_picture(on(half_side), on(room), 1, rounding);
          },
          needs_paths};
}

}  // namespace

std::vector<Row> geometry_rows(const Effort&) {
  return {grazing("a room 1e-3 high", {.height = 1e-3}),
          grazing("a room 1e-5 high", {.height = 1e-5}),
          grazing("the eye 1e-4 off a wall", {.eye = 1e-4F}),
          grazing("the eye 1e-6 off a wall", {.eye = 1e-6F}),
          on_a_floor(5e3),
          on_a_floor(5e5),
          cluttered("triangles without area", Clutter::zero_area),
          cluttered("vertices there twice", Clutter::duplicated_vertices),
          cluttered("surfaces that coincide", Clutter::coincident),
          cluttered("needles", Clutter::needles)};
}

}  // namespace lacuna::extremes
