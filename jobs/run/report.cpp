#include "jobs/run/report.h"
#include "jobs/run/report_parts.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "base/json/json_text.h"
#include "base/storage/peak_memory.h"
#include "jobs/run/artefacts_json.h"
#include "jobs/spec/described_json.h"
#include "jobs/spec/version.h"
#include "jobs/store/machine.h"
#include "renderer/images/image_module.h"

namespace lacuna {

namespace {

OrderedJson seconds(const PhaseSeconds& phases, const Spent& spent) {
  OrderedJson j;
  for (const auto& [name, value] : phases) j[name] = value;
  j["render"] = spent.seconds;
  j["render_cpu"] = spent.cpu_seconds;
  return j;
}

/// Time limits, with the times that count and that do not.
OrderedJson budget(const RenderTask& task, const Spent& spent) {
  const auto phase = [&](const char* name) {
    const auto found = task.phases.find(name);
    return found == task.phases.end() ? 0.0 : found->second;
  };
  return {{"seconds", number_or_null(task.spec.budget.seconds)},
          {"cpu_seconds", number_or_null(task.spec.budget.cpu_seconds)},
          {"render_seconds", spent.seconds},
          {"preparation_seconds", phase("load") + phase("analysis")}};
}

OrderedJson counts(const RenderLoop& loop) {
  const Counters& c = loop.counters();
  return {
      {"iterations", loop.spent().iterations}, {"samples", c.samples},   {"rays", c.rays},
      {"shadow_rays", c.shadow_rays},          {"negative", c.negative}, {"rejected", c.rejected},
      {"refused_rays", loop.refused_rays()}};
}

OrderedJson rates(const RenderTask& task, const Spent& spent, const Counters& c) {
  const auto rays = static_cast<double>(c.rays + c.shadow_rays);
  const auto per = [](double n, double t) {
    return t > 0 ? OrderedJson(n / t) : OrderedJson(nullptr);
  };
  return {{"rays_per_second", per(rays, spent.seconds)},
          {"rays_per_cpu_second", per(rays, spent.cpu_seconds * task.pool.threads())},
          {"samples_per_second", per(static_cast<double>(c.samples), spent.seconds)},
          {"rays_per_sample", per(rays, static_cast<double>(c.samples))}};
}

OrderedJson scene(const Scene& s, const std::string& camera) {
  const SceneData& d = s.data();
  return {
      {"camera", camera},
      {"triangles", d.triangle_count()},
      {"stored_triangles", d.stored_triangles()},  // those of instances once
      {"instances", d.instances.size()},
      {"dropped_triangles", d.dropped_triangles},
      {"emitters", s.has_emitters() ? OrderedJson(s.emitters().size()) : OrderedJson("not needed")},
      {"textures",
       {{"in_scene", d.textures.size()},
        {"decoded", s.textures_decoded()},
        {"decoded_bytes", s.texture_bytes()}}},
      {"mask_filters", s.rays().filters()},
      {"ray_caster_bytes", s.rays().bytes()},
      {"origin", {d.origin.x, d.origin.y, d.origin.z}},
      {"content_hash", fmt::format("{:016x}", d.content_hash)},
      {"geometry_hash", fmt::format("{:016x}", d.geometry_hash)}};
}

/// Whether est_rmse is reliable; null for too few iterations.
OrderedJson tail_json(const std::optional<ParetoTail>& tail) {
  if (!tail) return nullptr;
  return {{"index", std::isfinite(tail->index) ? OrderedJson(tail->index) : OrderedJson(nullptr)},
          {"limit", tail->limit},
          {"known", tail->mean_is_known()}};
}

OrderedJson errors_json(const RenderTask& task, const RenderLoop& loop) {
  OrderedJson j;
  const Curve& curve = loop.curve();
  if (curve.rows().empty()) return j;
  j["biased"] = biased(task.spec.integrator);
  const CurveRow& row = curve.rows().back();
  for (const ErrorMetricRow& metric : error_metrics) {
    j[std::string(metric.name)] = number_or_null(row.value(metric.value));
  }
  j["est_rmse_tail"] = tail_json(error_tail(loop.film()));
  const double mse = row.value(ErrorMetric::mse).value_or(0);
  if (mse > 0) j["efficiency"] = 1 / (mse * row.seconds);
  if (task.reference != nullptr) {
    j["reference"] = reference_json(*task.reference, row.at_floor);
  }
  return j;
}

/// Statistics of a merged picture.
OrderedJson merged_json(const RenderLoop& loop) {
  const MergedShards& merged = loop.merged();
  return {{"shards", merged.shards},
          {"iterations", merged.iterations},
          {"longest_seconds", loop.spent().longest_seconds},
          {"same_bits_as_one_machine", loop.same_bits_as_one()},
          {"learned_apart", merged.learned == 1},
          {"est_rmse", number_or_null(estimated_rmse(merged))}};
}

/// How parallel this process was, by section.
OrderedJson threads(const ThreadPool& pool) {
  double serial = 0, waiting = 0;
  OrderedJson sections = OrderedJson::object();
  for (const auto& [name, times] : pool.log().sections()) {
    if (times.serial + times.loops == 0) continue;
    if (name == reference_section) continue;  // another job, with its own threads and report
    const double waited = times.waiting(pool.threads());
    serial += times.serial;
    waiting += waited;
    sections[name] = {{"serial", times.serial},
                      {"loops", times.loops},
                      {"busy", times.busy},
                      {"waiting", waited},
                      {"bodies", times.bodies}};
  }
  return {{"serial_seconds", serial}, {"waiting_seconds", waiting}, {"sections", sections}};
}

/// When the image module was loaded, seconds from the job's start (negative: by an earlier job of
/// the process), and its cost. The time that the job waited for it is phase "images".
OrderedJson image_module(double started) {
  const auto times = image_module_times();
  if (!times) return "not needed";
  return {{"begun", times->begun - started},
          {"seconds", times->seconds},
          {"cpu_seconds", times->cpu_seconds}};
}

}  // namespace

std::optional<ParetoTail> error_tail(const Film& film) {
  return pareto_tail(film.squared_errors().largest(), film.squared_errors().count());
}

std::string write_report(const ReportInput& input) {
  const RenderTask& task = input.task;
  const RenderLoop& loop = input.loop;
  OrderedJson j;
  j["version"] = version();
  j["job"] = task.folder.id();
  j["seconds"] = seconds(task.phases, loop.spent());
  j["budget"] = budget(task, loop.spent());
  if (loop.merged().shards > 0) j["merged"] = merged_json(loop);
  j["counts"] = counts(loop);
  j["sums_exact"] = loop.film().exact();
  j["rates"] = rates(task, loop.spent(), loop.counters());
  if (const auto stats = task.integrator.statistics(); !stats.empty()) {
    for (const auto& [name, value] : stats) j["integrator"][name] = value;
  }
  if (input.choice) j["choice"] = ObjectWriter::value_of(*input.choice);
  j["errors"] = errors_json(task, loop);
  j["scene"] = scene(task.scene, input.camera);
  j["image_module"] = image_module(input.started);
  j["artefacts"] = artefacts_json(input.artefacts);
  j["warnings"] = input.warnings;
  j["threads"] = threads(task.pool);
  j["machine"] = machine_json(task.pool.threads(), input.disturbance);
  return document_text(j);
}

}  // namespace lacuna
