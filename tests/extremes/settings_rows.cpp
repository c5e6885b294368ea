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

/// Millions of lights, each for every pixel: a few pixels will do, and where there is little time
/// fewer lights.
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
void check_many_lights(Stage& stage, JobSpec job, const Furnace& furnace, bool quick,
                       const Method& method, Check& check) {
  auto& lights = std::get<ManyLightsSettings>(job.integrator);
  // Lights of one cell share a map: few cells, few maps.
  if (auto* maps = std::get_if<ViewMapsVisibilitySettings>(&lights.visibility)) maps->levels = 5;
  if (quick) {
    lights.light_paths = has_large_maps(method) ? 1 << 6 : 1 << 14;
    job.resolution = {4, 4};
    check_furnace(stage.render(job), method, furnace, check);
  } else {
    job.resolution = {2, 2};
    job.budget.iterations = 2;
    check.sound(stage.render(job));
  }
}

/// Nothing but whether it is sound is tested of these, and that shows at once; only a mean takes
/// longer.
bool has_no_known_mean(const Method& method) {
  return !max_depth(method) || from_lights_only(method);
}

/// In a quick run: fewer light paths, and where each of a thousand depths has tables of its own no
/// mean.
bool spare_connections(JobSpec& job) {
  auto* bdpt = std::get_if<BdptSettings>(&job.integrator);
  if (bdpt == nullptr) return false;
  const int most_paths = 1 << 13, most_tables = 100;
  const bool records = std::visit(
      [most_paths]<class S>(S& s) {
        if constexpr (requires { s.light_paths; })
          s.light_paths = std::min(s.light_paths, most_paths);
        constexpr bool hybrid = requires { s.cached_depth; };
        return !hybrid && requires { s.record_density; };
      },
      bdpt->connections);
  if (!records || bdpt->max_depth <= most_tables) return false;
  job.budget.iterations = 2;
  return true;
}

/// In a quick run: many chains, and long ones, without a mean.
bool spare_chains(JobSpec& job) {
  const auto* chains = std::get_if<MetropolisSettings>(&job.integrator);
  if (chains == nullptr || (chains->chains <= 1 << 14 && chains->mutations <= 100)) return false;
  job.budget.iterations = 2;
  return true;
}

Row at(End end, const std::string& name, const Effort& effort) {
  return {name,
          [=](Stage& stage, const Method& method, Check& check) {
            const Furnace f{.albedo = 0.5};
            const std::string& scene = stage.scene("furnace", [&] { return furnace(f); });
            for (const Method& m : with_numbers_at(method, end)) {
              JobSpec job = stage.job(m, scene);
              if (has_no_known_mean(m)) job.budget.iterations = effort.quick ? 1 : 2;
              check.or_refused([&] {
                if (has_too_many_lights(m) || has_large_maps(m)) {
                  check_many_lights(stage, job, f, effort.quick, m, check);
                } else if (effort.quick && (spare_connections(job) || spare_chains(job))) {
                  check.sound(stage.render(job));
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
  return {beyond(End::below, "numbers below their range"),
          at(End::lowest, "numbers at their least", effort),
          at(End::highest, "numbers at their most", effort),
          beyond(End::above, "numbers above their range")};
}

}  // namespace lacuna::extremes
