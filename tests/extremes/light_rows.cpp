// Brightness, and how many lights it comes from.
#include <fmt/format.h>

#include "renderer/images/texture_means.h"
#include "tests/extremes/rows.h"

namespace lacuna::extremes {
namespace {

Picture lit(Stage& stage, const Method& method, double radiance) {
  const std::string& name = stage.scene(fmt::format("room-lit-{}", radiance),
                                        [&] { return room({.radiance = radiance}); });
  return stage.render(stage.job(method, name));
}

/// 1: the picture shows light; 0: something else.
int light_degree(Stage& stage, const Method& method) {
  return degree(lit(stage, method, 2), stage.plain(method));
}

Row exactly_lit(int exponent) {
  return {fmt::format("radiance 2^{}: same bits", exponent),
          [=](Stage& stage, const Method& method, Check& check) {
            const int k = light_degree(stage, method);
            check.same_bits(lit(stage, method, std::ldexp(1.0, exponent)), stage.plain(method),
                            std::ldexp(1.0, k * exponent));
          }};
}

Row decimally_lit(double radiance) {
  return {fmt::format("radiance {:g}", radiance),
          [=](Stage& stage, const Method& method, Check& check) {
            constexpr double rounding = 2e-6;
            check.same_picture(lit(stage, method, radiance), stage.plain(method),
                               std::pow(radiance, light_degree(stage, method)), rounding);
          }};
}

/// Point lights by themselves.
Row glowing(int count, double power) {
  return {fmt::format("{} particles of {:g} W", count, power),
          [=](Stage& stage, const Method& method, Check& check) {
            JobSpec job =
                stage.job(method, stage.scene("dark room", [] { return room({.radiance = 0}); }));
            job.particles = ParticleSettings{.count = count, .power = 1, .seed = 7};
            const Picture one = stage.render(job);
            job.particles->power = power;
            constexpr double rounding = 2e-6;
            check.same_picture(stage.render(job), one, std::pow(power, light_degree(stage, method)),
                               rounding);
          }};
}

/// One scene in two versions that are one to the eye: every method sees the same.
Row the_same(const std::string& name, const Room& one, const Room& other) {
  return {name, [=](Stage& stage, const Method& method, Check& check) {
            const std::string& a = stage.scene(name + ", one", [&] { return room(one); });
            const std::string& b = stage.scene(name + ", other", [&] { return room(other); });
            constexpr double rounding = 1e-5;
            check.same_picture(stage.render(stage.job(method, b)),
                               stage.render(stage.job(method, a)), 1, rounding);
          }};
}

/// Half of a panel is dark by its texture, or has no emission; the eye sees the same. What is read
/// of the texture is all of it once, and a few hundred texels for each triangle at most.
Row textures_that_emit(int cells, int texels) {
  const std::string name = fmt::format("textures that emit: {} triangles", 2 * cells * cells);
  return {name, [=](Stage& stage, const Method& method, Check& check) {
            const std::string& plain = stage.scene(
                "half a panel", [&] { return room({.panel_cells = cells, .glow = Glow::half}); });
            const std::string& textured = stage.scene(name, [&] {
              return room({.panel_cells = cells, .glow = Glow::half_by_texture, .texels = texels});
            });
            const auto longer = [&](const std::string& scene) {  // half of the light, more noise
              JobSpec job = stage.job(method, scene);
              *job.budget.iterations *= 4;
              return job;
            };
            const JobSpec job = longer(textured);
            check.agree(stage.render(job), stage.render(longer(plain)));
            const double most =
                double(texels) * texels + 2.0 * cells * cells * TextureMeans::most_cells;
            const auto read = static_cast<double>(stage.texels_read(job));
            check.require(read <= most, fmt::format("{:g} texels were read for the power of the "
                                                    "emitters; at most {:g} are needed",
                                                    read, most));
          }};
}

/// What is lit by all of a spot's intensity is as bright as the inverse square of the distance
/// says, however narrow its cones.
Row narrow_spot(double outer, double inner) {
  return {fmt::format("narrow spots: {:g} rad{}", outer, inner < outer ? "" : ", hard edge"),
          [=](Stage& stage, const Method& method, Check& check) {
            const Beam spot{.outer = outer, .inner = inner};
            const JobSpec job = stage.job(
                method,
                stage.scene(fmt::format("beam-{}-{}", outer, inner), [&] { return beam(spot); }));
            const Picture picture = stage.render(job);
            check.sound(picture);
            if (max_depth(method)) check.mean_is(picture, spot.radiance());
          }};
}

}  // namespace

std::vector<Row> light_rows(const Effort& effort) {
  const int points = effort.quick ? 10'000 : 1'000'000;
  const int cells = effort.quick ? 71 : 708;  // squared and doubled: as many triangles
  return {
      exactly_lit(-40),
      exactly_lit(40),
      decimally_lit(1e-12),
      decimally_lit(1e12),
      glowing(1, 1e-12),
      glowing(1000, 1e12),
      the_same(fmt::format("{} points of light", points), {.points = 1}, {.points = points}),
      the_same("a panel thrice in one place", {}, {.panels = 3}),
      textures_that_emit(effort.quick ? 20 : 224, effort.quick ? 64 : 4096),
      narrow_spot(1e-2, 0.9e-2),
      narrow_spot(1e-4, 1e-4),
      the_same(fmt::format("{} shining triangles", 2 * cells * cells), {}, {.panel_cells = cells})};
}

}  // namespace lacuna::extremes
