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

/// The room lies `offset` from the origin, where a float no longer resolves it: nodes place it, and
/// so it is moved to the origin before anything is rounded. There it is as far off its place as a
/// double at `offset` rounds.
Row far_away(double offset) {
  return {
      fmt::format("offset {:g}", offset), [=](Stage& stage, const Method& method, Check& check) {
        const double rounding = std::max(1e-5, offset * 0x1p-50);
        const std::string& name = stage.scene(fmt::format("room-at-{}", offset),
                                              [=] { return room({.offset = offset}); });
        check.same_picture(stage.render(stage.job(method, name)), stage.plain(method), 1, rounding);
      }};
}

Row far_furnace(double offset) {
  return {fmt::format("furnace at {:g}", offset),
          [=](Stage& stage, const Method& method, Check& check) {
            const Furnace f{.offset = offset};
            const std::string& name =
                stage.scene(fmt::format("furnace-at-{}", offset), [&] { return furnace(f); });
            check_furnace(stage.render(stage.job(method, name)), method, f, check);
          }};
}

}  // namespace

std::vector<Row> scale_rows(const Effort&) {
  return {exact(-20),     exact(20),        decimal(1e-6),   decimal(1e-3),
          decimal(1e3),   decimal(1e6),     far_away(1e5),   far_away(1e7),
          far_away(1e11), far_furnace(1e5), far_furnace(1e7)};
}

}  // namespace lacuna::extremes
