#pragma once

#include "tests/extremes/check.h"

namespace lacuna::extremes {

/// A row of the matrix: one extreme, that every method is put through.
struct Row {
  std::string name;
  std::function<void(Stage&, const Method&, Check&)> run;
  /// Why the row does not concern a method; empty: it does.
  std::function<std::string(const Method&)> left_out = [](const Method&) { return ""; };
};

// Each group in its own file.
std::vector<Row> scale_rows(const Effort& effort);
std::vector<Row> light_rows(const Effort& effort);
std::vector<Row> surface_rows(const Effort& effort);
std::vector<Row> geometry_rows(const Effort& effort);
std::vector<Row> accumulation_rows(const Effort& effort);
std::vector<Row> space_rows(const Effort& effort);
std::vector<Row> settings_rows(const Effort& effort);
std::vector<Row> output_rows(const Effort& effort);
std::vector<Row> budget_rows(const Effort& effort);
std::vector<Row> input_rows(const Effort& effort);

/// For Row::left_out: methods that do not estimate light along paths.
inline std::string needs_paths(const Method& method) {
  return max_depth(method) ? "" : "does not follow light, or is biased";
}

/// What a furnace shows, in units of its radiance, with paths of at most `depth` edges.
inline double furnace_mean(double albedo, int depth) {
  double sum = 0, term = 1;
  for (int k = 0; k < depth; ++k, term *= albedo) sum += term;
  return sum;
}

/// For Row::left_out: methods that sample nothing from the eye.
inline std::string needs_eye_paths(const Method& method) {
  return from_lights_only(method) ? "follows nothing from the eye: mirrors are black to it" : "";
}

/// A picture of a furnace is what it has to be: known, for a method that follows light. To one that
/// follows it from the lights alone a furnace is only noise: all of it shines, little is seen.
inline void check_furnace(const Picture& picture, const Method& method, const Furnace& furnace,
                          Check& check) {
  check.sound(picture);
  if (const auto depth = max_depth(method); depth && !from_lights_only(method)) {
    check.mean_is(picture, furnace.radiance * furnace_mean(furnace.albedo, *depth));
  }
}

}  // namespace lacuna::extremes
