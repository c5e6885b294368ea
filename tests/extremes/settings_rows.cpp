// Every number of a method's tables at both ends of its range, and beyond them.
#include <fmt/format.h>

#include <algorithm>

#include "jobs/spec/job_json.h"
#include "tests/extremes/rows.h"

namespace lacuna::extremes {
namespace {

std::string needs_numbers(const Method& method) {
  return with_numbers_at(method, End::lowest).empty() &&
                 with_numbers_at(method, End::highest).empty()
             ? "has no number in its tables"
             : "";
}

/// Millions of lights, each for every pixel: a few pixels will do.
bool has_too_many_lights(const Method& method) {
  const auto* lights = std::get_if<ManyLightsSettings>(&method.settings);
  return lights != nullptr && lights->light_paths > 1 << 14;
}
/// Maps of megabytes, each for a light: few lights will do.
bool has_large_maps(const Method& method) {
  const auto* lights = std::get_if<ManyLightsSettings>(&method.settings);
  if (lights == nullptr) return false;
  const auto* maps = std::get_if<ViewMapsVisibilitySettings>(&lights->visibility);
  return maps != nullptr && maps->map_size > 256;
}
void check_many_lights(Stage& stage, JobSpec job, Check& check) {
  auto& lights = std::get<ManyLightsSettings>(job.integrator);
  // Lights of one cell share a map: few cells, few maps.
  if (auto* maps = std::get_if<ViewMapsVisibilitySettings>(&lights.visibility)) maps->levels = 5;
  job.resolution = {2, 2};
  job.budget.iterations = 2;
  check.sound(stage.render(job));
}

/// Nothing but whether it is sound is tested of these, and that shows at once; only a mean takes
/// longer.
bool has_no_known_mean(const Method& method) {
  return !max_depth(method) || from_lights_only(method);
}

Row at(End end, const std::string& name) {
  return {name,
          [=](Stage& stage, const Method& method, Check& check) {
            const Furnace f{.albedo = 0.5};
            const std::string& scene = stage.scene("furnace", [&] { return furnace(f); });
            for (const Method& m : with_numbers_at(method, end)) {
              JobSpec job = stage.job(m, scene);
              if (has_no_known_mean(m)) job.budget.iterations = 2;
              check.or_refused([&] {
                if (has_too_many_lights(m) || has_large_maps(m)) {
                  check_many_lights(stage, job, check);
                } else {
                  check_furnace(stage.render(job), m, f, check);
                }
              });
            }
          },
          needs_numbers};
}

Row beyond(End end, const std::string& name) {
  return {name,
          [=](Stage& stage, const Method& method, Check& check) {
            for (const Method& m : with_numbers_at(method, end)) {
              const std::string json = write_job(stage.job(m, "any.glb"));
              std::string setting = m.name.substr(method.name.size() + 1);
              setting.resize(setting.find('='));
              std::replace(setting.begin(), setting.end(), '.', '/');  // as in its JSON pointer
              check.refused([&] { parse_job(json); }, setting);
            }
          },
          needs_numbers};
}

}  // namespace

std::vector<Row> settings_rows(const Effort& effort) {
  std::vector<Row> rows{beyond(End::below, "numbers below their range"),
                        at(End::lowest, "numbers at their least"),
                        beyond(End::above, "numbers above their range")};
  if (!effort.quick) rows.push_back(at(End::highest, "numbers at their most"));
  return rows;
}

}  // namespace lacuna::extremes
