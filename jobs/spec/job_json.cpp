#include "jobs/spec/job_json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "jobs/spec/described_json.h"
#include "renderer/settings/path_expression.h"

namespace lacuna {
namespace {

/// Whether no problem was found at this position or below: the settings there equal the document.
bool is_good(const std::vector<Problem>& problems, const std::string& at) {
  return std::none_of(problems.begin(), problems.end(), [&](const Problem& p) {
    return p.pointer == at || p.pointer.starts_with(at + '/');
  });
}

void check_error_target(const JobSpec& spec, std::vector<Problem>& problems) {
  if (!spec.budget.error || !needs_reference(spec.budget.error->metric)) return;
  if (!spec.reference.empty()) return;
  if (!is_good(problems, "/budget/error") || !is_good(problems, "/reference")) return;
  problems.push_back(
      {"/budget/error/metric",
       fmt::format("found \"{}\" in a job without \"reference\"; allowed: \"{}\", "
                   "or any metric together with a reference",
                   enum_name(spec.budget.error->metric), enum_name(ErrorMetric::est_rmse))});
}

/// The available layers depend on the integrator.
void check_layers_of_integrator(const JobSpec& spec, std::vector<Problem>& problems) {
  if (!is_good(problems, "/layers") || !is_good(problems, "/integrator")) return;
  const std::vector<ImageLayer> offered = offered_layers(spec.integrator);
  std::vector<std::string_view> allowed;
  allowed.reserve(offered.size());
  for (const ImageLayer layer : offered) allowed.push_back(enum_name(layer));
  const auto integrator = std::visit([](const auto& s) { return s.name; }, spec.integrator);
  for (std::size_t i = 0; i < spec.layers.size(); ++i) {
    const LayerRequest& layer = spec.layers[i];
    const bool by_letters = layer.object.has_value();
    if (!by_letters && std::ranges::find(offered, layer.word) != offered.end()) continue;
    std::string_view reason;
    if (by_letters) reason = without_letters(spec.integrator);
    if (by_letters && reason.empty()) continue;
    if (!by_letters && layer.word == ImageLayer::lengths) reason = without_lengths(spec.integrator);
    problems.push_back(
        {fmt::format("/layers/{}", i),
         fmt::format("found {} in a job of integrator \"{}\"{}{}; allowed there: \"{}\"{}",
                     by_letters ? "an expression" : fmt::format("\"{}\"", enum_name(layer.word)),
                     integrator, reason.empty() ? "" : ", which ", reason,
                     fmt::join(allowed, "\", \""),
                     without_letters(spec.integrator).empty() ? ", or an expression" : "")});
  }
}

/// The expressions of light paths, and their names.
void check_light_paths(const JobSpec& spec, std::vector<Problem>& problems) {
  if (!is_good(problems, "/layers")) return;
  std::vector<PathExpression> expressions;
  std::size_t count = 0;
  for (std::size_t i = 0; i < spec.layers.size(); ++i) {
    if (!spec.layers[i].object) continue;
    const LightPathsLayer& layer = *spec.layers[i].object;
    const std::string at = fmt::format("/layers/{}", i);
    if (++count > most_light_paths_layers) {
      problems.push_back({at, fmt::format("found {} layers of expressions; allowed: {} at most",
                                          count, most_light_paths_layers)});
    }
    try {
      expressions.push_back(path_expression(layer.light));
      if (count <= most_light_paths_layers) path_automaton(expressions);
    } catch (const std::logic_error& e) {
      problems.push_back({at + "/light", fmt::format("\"{}\": {}", layer.light, e.what())});
    }
    const auto is_plain = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
             c == '_' || c == '-';
    };
    if (!std::ranges::all_of(layer.name, is_plain)) {
      problems.push_back(
          {at + "/name",
           fmt::format("found \"{}\"; allowed: letters, digits, _ and -", layer.name)});
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (!spec.layers[k].object || spec.layers[k].object->name != layer.name) continue;
      problems.push_back(
          {at + "/name", fmt::format("found \"{}\" again; allowed: each name once", layer.name)});
      break;
    }
  }
}

template <class Settings>
void check_conflict(const std::string& at, const Settings& settings,
                    std::vector<Problem>& problems) {
  const std::string_view found = conflict(settings);
  if (!found.empty() && is_good(problems, at)) {
    problems.push_back({at, fmt::format("found {}", found)});
  }
}

/// Candidates have the path lengths of `auto` and at most the bias that it allows.
void check_candidates(const JobSpec& spec, std::vector<Problem>& problems) {
  const auto* settings = std::get_if<AutoSettings>(&spec.integrator);
  if (settings == nullptr || !is_good(problems, "/integrator")) return;
  for (std::size_t i = 0; i < settings->candidates.size(); ++i) {
    const std::string at = fmt::format("/integrator/candidates/{}", i);
    const PathLengths& lengths =
        std::visit([](const auto& s) -> const PathLengths& { return s; }, settings->candidates[i]);
    if (lengths != PathLengths{} && lengths != static_cast<const PathLengths&>(*settings)) {
      problems.push_back(
          {at, fmt::format("found max_depth {} and roulette_depth {}; allowed: those of the "
                           "integrator \"auto\", {} and {}, or none",
                           lengths.max_depth, lengths.roulette_depth, settings->max_depth,
                           settings->roulette_depth)});
    }
    if (!is_allowed(settings->candidates[i], settings->allow)) {
      problems.push_back({at, fmt::format("found settings that make the picture biased; allowed by "
                                          "\"allow\": \"{}\": settings with no more bias",
                                          enum_name(settings->allow))});
    }
    CandidateSettings complete = settings->candidates[i];
    std::visit([&](PathLengths& lengths_there) { lengths_there = *settings; }, complete);
    check_conflict(at, complete, problems);
  }
  const auto& all = settings->candidates;
  const bool one_is_right =
      all.empty() || std::any_of(all.begin(), all.end(), [](const auto& c) { return !biased(c); });
  if (!one_is_right && settings->allow != Allow::unbiased) {
    problems.push_back({"/integrator/candidates",
                        "found no unbiased one; allowed: lists with one, against which the bias of "
                        "the others is measured"});
  }
}

/// Another program's pictures have no layers and no iterations.
void check_foreign(const JobSpec& spec, std::vector<Problem>& problems) {
  if (!std::holds_alternative<ForeignSettings>(spec.integrator)) return;
  if (!spec.layers.empty()) {
    problems.push_back(
        {"/layers", "found layers in a job of integrator \"foreign\"; allowed: none"});
  }
  if (spec.shards > 1) {
    problems.push_back({"/shards", fmt::format("found {} in a job of integrator \"foreign\"; "
                                               "allowed: 1",
                                               spec.shards)});
  }
}

void check_layers_once(const JobSpec& spec, std::vector<Problem>& problems) {
  if (!is_good(problems, "/layers")) return;
  for (auto it = spec.layers.begin(); it != spec.layers.end(); ++it) {
    if (it->object || std::find(spec.layers.begin(), it, *it) == it) continue;
    problems.push_back(
        {fmt::format("/layers/{}", it - spec.layers.begin()),
         fmt::format("found \"{}\" again; allowed: each layer once", enum_name(it->word))});
  }
}

void check_crop(const JobSpec& spec, std::vector<Problem>& problems) {
  if (!spec.crop || !is_good(problems, "/crop") || !is_good(problems, "/resolution")) return;
  for (std::size_t k = 0; k < 2; ++k) {
    const int least = spec.crop->from[k] + spec.resolution[k];
    if (spec.crop->of[k] >= least) continue;
    problems.push_back(
        {fmt::format("/crop/of/{}", k),
         fmt::format("found {} for a crop that begins with {} and has {}; allowed: "
                     "{} or more",
                     spec.crop->of[k], spec.crop->from[k], spec.resolution[k], least)});
  }
}

/// What belongs to another kind of camera would be left out silently.
void check_projection(const CameraSettings& camera, PixelFilter filter,
                      std::vector<Problem>& problems) {
  const CameraSettings none;
  const auto unused = [&](std::string_view key, double found, double otherwise, bool used,
                          std::string_view where) {
    if (used || found == otherwise) return;
    problems.push_back(
        {fmt::format("/camera/{}", key),
         fmt::format("found {} in a camera that does not use it; allowed: {}", found, where)});
  };
  const bool perspective = camera.type == Projection::perspective;
  const bool lens = perspective && camera.aperture > 0;
  const std::string_view of_perspective = "type \"perspective\"";
  const std::string_view of_lens = "an aperture above 0 of a perspective camera";
  unused("fov", camera.fov, none.fov, perspective, of_perspective);
  unused("height", camera.height, none.height, camera.type == Projection::orthographic,
         "type \"orthographic\"");
  unused("aperture", camera.aperture, 0, perspective, of_perspective);
  unused("focus", camera.focus, 0, lens, of_lens);
  unused("blades", camera.blades, 0, lens, of_lens);
  if (camera.blades == 1 || camera.blades == 2) {
    problems.push_back(
        {"/camera/blades", fmt::format("found {}; allowed: 0, or 3 to 64", camera.blades)});
  }
  if (camera.type == Projection::panorama && filter != PixelFilter::box) {
    problems.push_back({"/pixel_filter", fmt::format("found \"{}\" with a panorama; allowed: "
                                                     "\"box\"",
                                                     enum_name(filter))});
  }
}

void check_camera(const JobSpec& spec, std::vector<Problem>& problems) {
  if (!spec.camera.object || !is_good(problems, "/camera")) return;
  const CameraSettings& camera = *spec.camera.object;
  check_projection(camera, spec.pixel_filter, problems);
  if (frame_of(camera)) return;
  CameraSettings upright = camera, sideways = camera;
  upright.up = {0, 1, 0}, sideways.up = {1, 0, 0};
  if (!frame_of(upright) && !frame_of(sideways)) {
    problems.push_back(
        {"/camera/target", fmt::format("found {}, the camera's position, or too near to it for "
                                       "double precision; allowed: another point",
                                       json_text(OrderedJson(camera.target)))});
    return;
  }
  problems.push_back({"/camera/up", fmt::format("found {}, which is 0 or along the view; allowed: "
                                                "another direction",
                                                json_text(OrderedJson(camera.up)))});
}

void check_shard(const JobSpec& spec, std::vector<Problem>& problems) {
  if (!is_good(problems, "/shards") || !is_good(problems, "/shard")) return;
  if (spec.shards > 1 && std::holds_alternative<AutoSettings>(spec.integrator)) {
    problems.push_back({"/shards", fmt::format("found {} in a job of integrator \"auto\", whose "
                                               "shards might choose different methods; allowed: "
                                               "1, or the method that `lacuna advise` names",
                                               spec.shards)});
  }
  if (spec.shard <= spec.shards) return;
  problems.push_back({"/shard", fmt::format("found {}; allowed: 0 to {}, the number of shards",
                                            spec.shard, spec.shards)});
}

bool has_limit(const Budget& b) { return b.seconds || b.cpu_seconds || b.iterations || b.error; }

}  // namespace

std::int64_t most_shards(std::int64_t iterations) { return (iterations + 1) / 2; }

JobSpec parse_job(std::string_view json) {
  std::vector<Problem> problems;
  const Json document = parse_document(json, {max_job_bytes, max_json_depth}, problems);
  JobSpec spec;
  read_settings(document, problems, spec);
  check_error_target(spec, problems);
  check_layers_of_integrator(spec, problems);
  check_conflict("/integrator", spec.integrator, problems);
  check_candidates(spec, problems);
  check_foreign(spec, problems);
  check_layers_once(spec, problems);
  check_light_paths(spec, problems);
  check_crop(spec, problems);
  check_camera(spec, problems);
  check_shard(spec, problems);
  throw_if_any(std::move(problems));
  if (!has_limit(spec.budget)) spec.budget.seconds = Budget::default_seconds;
  return spec;
}

template OrderedJson ObjectWriter::value_of(const JobSpec& job);

std::string write_job(const JobSpec& spec) { return write_document(spec); }

}  // namespace lacuna
