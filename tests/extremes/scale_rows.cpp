// Size and place: the same picture as unscaled.
#include <fmt/format.h>

#include "tests/extremes/rows.h"

namespace lacuna::extremes {
namespace {

/// For Row::left_out: methods with a length in the scene's own units among their settings.
std::string needs_no_units(const Method& method) {
  const auto* lights = std::get_if<ManyLightsSettings>(&method.settings);
  const bool absolute = lights != nullptr && lights->clamp == Clamp::absolute;
  return absolute ? "its bound is in the scene's own units" : "";
}

Picture scaled(Stage& stage, const Method& method, double scale) {
  const std::string& name =
      stage.scene(fmt::format("room-scaled-{}", scale), [&] { return room({.scale = scale}); });
  return stage.render(stage.job(method, name));
}

/// A picture may show lengths (its degree is 1) or what has none, as radiance (0). Found where
/// twice the size is exact, it has to hold at every size.
int length_degree(Stage& stage, const Method& method) {
  return degree(scaled(stage, method, 2), stage.plain(method));
}

Row exact(int exponent) {
  return {fmt::format("scale 2^{}: same bits", exponent),
          [=](Stage& stage, const Method& method, Check& check) {
            const int k = length_degree(stage, method);
            check.same_bits(scaled(stage, method, std::ldexp(1.0, exponent)), stage.plain(method),
                            std::ldexp(1.0, k * exponent));
          },
          needs_no_units};
}

Row decimal(double scale) {
  return {fmt::format("scale {:g}", scale),
          [=](Stage& stage, const Method& method, Check& check) {
            // Corners are rounded to 24 bits, so that a few in a million of the paths meet another
            // surface.
            constexpr double rounding = 1e-5;
            check.same_picture(scaled(stage, method, scale), stage.plain(method),
                               std::pow(scale, length_degree(stage, method)), rounding);
          },
          needs_no_units};
}

/// At 1e7 the floats are 1 apart. The room is made so large that its corners are whole numbers: its
/// shape is exact, and what changes is that rays begin and end 2^-19 of the coordinates beside
/// their surfaces (offset_origin), here 19 units, or a 2500th of the room's height. On strips of
/// that width along the edges of the room and of its shadows the picture may be another.
Row far_away() {
  return {"offset 1e7",
          [](Stage& stage, const Method& method, Check& check) {
            constexpr double scale = 0x1p14;
            const double strip = 1e7 * 0x1p-19 / (2.9 * scale);
            const std::string& name =
                stage.scene("room-far", [&] { return room({.scale = scale, .offset = 1e7}); });
            check.same_picture(stage.render(stage.job(method, name)), stage.plain(method),
                               std::pow(scale, length_degree(stage, method)), 2 * strip);
          },
          needs_no_units};
}

/// The room in its own size is four to six floats wide out there: no longer the same shape, but
/// still a picture or a refusal.
Row far_away_and_small() {
  return {"offset 1e7, size 4: any picture", [](Stage& stage, const Method& method, Check& check) {
            const std::string& name =
                stage.scene("room-far-small", [] { return room({.offset = 1e7}); });
            check.or_refused([&] { check.sound(stage.render(stage.job(method, name))); });
          }};
}

}  // namespace

std::vector<Row> scale_rows(const Effort&) {
  return {exact(-20),   exact(20),    decimal(1e-6), decimal(1e-3),
          decimal(1e3), decimal(1e6), far_away(),    far_away_and_small()};
}

}  // namespace lacuna::extremes
