// How much surfaces reflect, and how sharply.
#include <fmt/format.h>

#include "tests/extremes/rows.h"

namespace lacuna::extremes {
namespace {

Row reflecting(double albedo, const std::string& text) {
  return {"albedo " + text, [=](Stage& stage, const Method& method, Check& check) {
            const Furnace f{.albedo = albedo};
            const std::string& name =
                stage.scene("furnace, albedo " + text, [&] { return furnace(f); });
            check_furnace(stage.render(stage.job(method, name)), method, f, check);
          }};
}

/// A block among black walls that shine: it reflects no more than what it gets, however rough it
/// is, and all methods that follow light show the same.
Row rough(const std::string& what, double roughness, const Json& material) {
  const std::string name = fmt::format("{}, roughness {:g}", what, roughness);
  return {name, [=](Stage& stage, const Method& method, Check& check) {
            const std::string& scene =
                stage.scene(name, [&] { return furnace({.albedo = 0, .content = material}); });
            const Picture picture = stage.render(stage.job(method, scene));
            check.sound(picture);
            if (!max_depth(method)) return;
            check.at_most(picture, 1);
            JobSpec other = stage.job(reference_for(method), scene);
            other.seed = 2;
            check.agree(picture, stage.render(other));
          },
          needs_eye_paths};
}

/// Independent pictures of the same room by every method that follows light.
Row agreement() {
  return {"the room: all agree",
          [](Stage& stage, const Method& method, Check& check) {
            const std::string& name = stage.scene("room", [] { return room({}); });
            JobSpec first = stage.job(reference_for(method), name);
            first.seed = 2;
            JobSpec own = stage.job(method, name);
            *own.budget.iterations *= 16;  // light met by chance is noisy
            check.agree(stage.render(own), stage.render(first));
          },
          needs_paths};
}

}  // namespace

std::vector<Row> surface_rows(const Effort&) {
  std::vector<Row> rows{agreement(), reflecting(0, "0"), reflecting(1 - 1e-7, "1 - 1e-7"),
                        reflecting(1, "1")};
  for (const double roughness : {0.0, 1e-4, 0.01, 0.1, 1.0}) {
    rows.push_back(rough("metal", roughness, metal(roughness)));
    rows.push_back(rough("glass", roughness, glass(roughness)));
  }
  return rows;
}

}  // namespace lacuna::extremes
