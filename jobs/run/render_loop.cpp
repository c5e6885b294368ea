#include "jobs/run/render_loop.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "base/storage/atomic_file.h"
#include "base/storage/available_memory.h"
#include "jobs/run/checkpoint.h"
#include "jobs/run/obstacle.h"
#include "jobs/spec/identity.h"
#include "jobs/spec/version.h"
#include "renderer/film/preview.h"

namespace lacuna {

namespace {

// Maximum shares of time for checkpoints and previews.
constexpr double checkpoint_share = 0.01;
constexpr double preview_share = 0.005;
constexpr double flip_share = 0.05;  // of FLIP, which costs more than all other errors together
constexpr double progress_interval = 0.5;  // seconds
constexpr double preview_interval = 1;     // seconds: shorter jobs write their picture at the end

LightLayers light_layers_of(const JobSpec& spec) {
  const std::vector<ImageLayer> named = named_layers(spec.layers);
  const bool lengths = std::ranges::find(named, ImageLayer::lengths) != named.end();
  return {lengths, light_paths_layers(spec.layers), most_edges(spec.integrator)};
}

}  // namespace

RenderLoop::RenderLoop(const RenderTask& task)
    : task_(task),
      budget_(budget_of(task.spec)),
      light_(light_layers_of(task.spec)),
      state_(task.spec, layer_names(), memory_to_take()),
      frame_(task.spec.resolution[0], task.spec.resolution[1]),
      clock_(task.pool.threads()),
      checkpoints_(task.spec.checkpoint_seconds, checkpoint_share),
      previews_(preview_interval, preview_share),
      progress_(progress_interval, checkpoint_share),
      flips_(0, flip_share) {}

std::vector<std::string> RenderLoop::layer_names() {
  std::vector<std::string> names = task_.integrator.layers(named_layers(task_.spec.layers));
  own_layers_ = names.size();
  names.insert(names.end(), light_.names().begin(), light_.names().end());
  return names;
}

std::string RenderLoop::identity() const {
  std::string layers = fmt::format("{}", fmt::join(state_.layers.names(), " "));
  for (const LightPathsLayer& l : light_paths_layers(task_.spec.layers))
    layers += fmt::format(" {}", l.light);
  return checkpoint_key({picture_key(task_.spec), task_.content, version(), layers});
}

void RenderLoop::stop_if_interrupted() const {
  if (task_.interrupted()) throw Stopped{};
}

bool RenderLoop::load(const JobFolder& folder) {
  const auto file = folder.file("checkpoint.bin");
  const auto load = [&](ByteReader& in) {
    state_.load(in);
    task_.integrator.load(in);
  };
  try {
    return read_checkpoint(file, identity(), load, [&] { stop_if_interrupted(); });
  } catch (const std::system_error&) {
    throw;  // transient: the checkpoint may be intact
  } catch (const std::runtime_error& e) {
    std::filesystem::rename(file, folder.file("checkpoint.unusable"));
    task_.observer.warning(
        fmt::format("{}; kept as checkpoint.unusable, rendering starts again", e.what()));
    const std::vector<std::string> layers = state_.layers.names();
    state_.layers = {};  // frees their memory
    state_ = RunState(task_.spec, layers, memory_to_take());
    return false;
  }
}

void RenderLoop::count_phases() {
  for (const auto& [name, seconds] : state_.phases) task_.phases[name] += seconds;
  clock_.set(state_.spent.seconds, state_.spent.cpu_seconds);
}

void RenderLoop::resume() {
  if (!load(task_.folder)) return;
  count_phases();
  saved_ = state_.spent;
  report_progress(saved_);
  task_.observer.milestone(
      fmt::format("continuing from iteration {} ({:.1f} s)", saved_.iterations, saved_.seconds));
}

void RenderLoop::begin_from(const JobFolder& other, const Spent& elsewhere) {
  if (!load(other)) return;
  Spent& spent = state_.spent;
  spent.seconds += elsewhere.seconds;
  spent.cpu_seconds += elsewhere.cpu_seconds;
  spent.longest_seconds += elsewhere.seconds;
  count_phases();
  // The ray caster of this scene may have counted its rays in this process.
  state_.refused_rays -= std::min(state_.refused_rays, task_.scene.rays().refused_rays());
  state_.curve = {};  // its times do not include `elsewhere`
  add_row();
}

void RenderLoop::merge(const std::vector<Shard>& shards) {
  merging_ = true;
  const auto add_shard = [&] {
    if (state_.curve.due(state_.spent.seconds)) add_row();
    report_progress(state_.spent);
    stop_if_interrupted();
  };
  merge_shards(shards, identity(), state_,
               {[&](ByteReader& in) { task_.integrator.load(in); }, add_shard,
                [&] { stop_if_interrupted(); }});
  count_phases();
}

Spent RenderLoop::elapsed() const {
  Spent all = state_.spent;
  all.seconds = clock_.seconds();
  all.cpu_seconds = clock_.cpu_seconds();
  return all;
}

bool RenderLoop::same_bits_as_one() const {
  return state_.merged.shards == 0 ||
         (state_.merged.learned == 0 && state_.done.is_whole() && state_.film.exact());
}

std::uint64_t RenderLoop::refused_rays() const {
  return state_.refused_rays + task_.scene.rays().refused_rays();
}

RenderLoop::End RenderLoop::run() {
  return run_until(budget_,
                   [&] { return state_.spent.iterations > 0 && out_of_time(budget_, elapsed()); });
}

RenderLoop::End RenderLoop::run_part(const Budget& part, const std::optional<Budget>& limit) {
  return run_until(part, [&] {
    return state_.spent.iterations == 0 && limit && out_of_time(*limit, elapsed());
  });
}

RenderLoop::End RenderLoop::run_until(const Budget& budget, const std::function<bool()>& late) {
  const auto stopped = [&] {
    report_progress(saved_);
    return End::interrupted;
  };
  bool kept = false;  // the checkpoint contains this state
  while (!merging_ && !exhausted(budget, state_.spent) && !would_overrun(budget, state_.spent) &&
         !target_met(budget, state_.curve)) {
    if (task_.interrupted() || !iterate(late)) {
      if (!task_.interrupted()) break;  // out of time
      if (!kept) write_checkpoint_now();
      return stopped();
    }
    // The error target is tested only at these instants, like any other use of the error.
    if (state_.curve.due(state_.spent.seconds)) add_row();
    kept = checkpoints_.due() && write_checkpoint_now();
    if (progress_.due()) report_progress(state_.spent);
  }
  if (state_.spent.iterations == 0) return End::no_iteration;
  add_row(true);
  if (!write_last_checkpoint()) return stopped();
  report_progress(state_.spent);
  return End::spent;
}

bool RenderLoop::write_last_checkpoint() {
  if (saved_.iterations == state_.spent.iterations) return true;
  try {
    return write_checkpoint_now();
  } catch (const std::system_error& e) {
    if (obstacle_of(e) != Obstacle::storage) throw;
    // The results need less space. A larger budget would continue from the previous checkpoint.
    task_.observer.warning(e.what());
    return true;
  }
}

bool RenderLoop::iterate(const std::function<bool()>& late) {
  const std::function<bool()> stop = [&] { return task_.interrupted() || late(); };
  const std::uint64_t iteration = state_.done.next();
  const WorkSection section(task_.pool, "iteration");
  task_.pool.for_each(frame_.height,
                      [&](int y) { std::fill_n(&frame_.at(0, y), frame_.width, Rgb(0, 0, 0)); });
  const std::span<Image> layers = state_.layers.begin(task_.pool);
  clock_.start();
  try {
    state_.counters += task_.integrator.iterate({.scene = task_.scene,
                                                 .camera = task_.camera,
                                                 .pool = task_.pool,
                                                 .seed = task_.spec.seed,
                                                 .iteration = iteration,
                                                 .stop = stop,
                                                 .layers = layers.first(own_layers_),
                                                 .sampler = task_.spec.sampler,
                                                 .light = {light_, layers.subspan(own_layers_)}},
                                                frame_);
  } catch (const Stopped&) {
    clock_.stop();
    return false;
  }
  {
    const WorkSection film(task_.pool, "film");
    state_.film.add(iteration, frame_, &task_.pool);
  }
  clock_.stop();
  state_.done.add_next();
  Spent& spent = state_.spent;
  const double longest = spent.longest_seconds + clock_.seconds() - spent.seconds;
  spent = {spent.iterations + 1, clock_.seconds(), clock_.cpu_seconds(), longest};
  if (!layers.empty()) {
    const ScopedSeconds timed(task_.phases["layers"]);  // not part of the estimate
    const WorkSection layer_means(task_.pool, "layers");
    state_.layers.add(task_.pool);
  }
  return true;
}

std::optional<double> RenderLoop::measure_flip(bool last) {
  const bool is_target = budget_.error && budget_.error->metric == ErrorMetric::flip;
  if (!last && !is_target && !flips_.due()) return std::nullopt;
  const std::vector<double>& reference = task_.reference->rgb;
  double cost = 0;
  std::optional<double> flip;
  try {
    const ScopedSeconds timed(cost);
    if (!flip_exposures_) flip_exposures_ = flip_exposures(reference);
    flip = flip_mean(hdr_flip({state_.film.mean(), reference, frame_.width, frame_.height},
                              *flip_exposures_, &task_.pool));
  } catch (const Stopped&) {
    return std::nullopt;  // the loop sees the interruption
  }
  flips_.done(cost);
  return flip;
}

void RenderLoop::add_row(bool last) {
  if (state_.spent.iterations == 0) return;
  double cost = 0;
  {
    const ScopedSeconds timed(cost);
    const WorkSection section(task_.pool, "evaluate");
    CurveRow row{state_.spent.iterations,
                 state_.spent.seconds,
                 state_.spent.cpu_seconds,
                 state_.spent.longest_seconds,
                 state_.counters,
                 std::nullopt,
                 std::nullopt,
                 estimated_rmse(state_.film),
                 false};
    if (task_.reference != nullptr) {
      row.errors = errors(state_.film.mean(), task_.reference->rgb);
      row.flip = measure_flip(last);
      row.at_floor =
          task_.reference->mse && *task_.reference->mse > (*row.errors)[ErrorMetric::mse] / 2;
    }
    state_.curve.add(row);
    write_file_atomically(task_.folder.file("curve.csv"), state_.curve.csv(), false);
  }
  task_.phases["evaluate"] += cost;
  if (previews_.due()) write_preview_now();
  std::string line =
      fmt::format("iteration {}, {:.1f} s", state_.spent.iterations, state_.spent.seconds);
  for (const ErrorMetric m : {ErrorMetric::rmse, ErrorMetric::relmse, ErrorMetric::est_rmse}) {
    const auto error = state_.curve.rows().back().value(m);
    if (error) line += fmt::format(", {} {:.4g}", enum_name(m), *error);
  }
  if (state_.curve.rows().back().at_floor) line += ", at the reference's noise";
  task_.observer.milestone(line);
  if (state_.curve.rows().back().at_floor && !std::exchange(floor_told_, true)) {
    task_.observer.milestone(fmt::format(
        "the reference's own noise, rmse {:.4g}, is more than half of the mse: measured errors "
        "stop falling; use a reference with less noise (reference_iterations)",
        std::sqrt(*task_.reference->mse)));
  }
}

bool RenderLoop::write_checkpoint_now() {
  const auto save = [&](ByteWriter& out) {
    std::uint64_t learned = 0;
    ByteWriter count([&](std::string_view piece) { learned += piece.size(); });
    task_.integrator.save(count);
    count.flush();
    state_.save(out, refused_rays(), task_.phases, learned);
    task_.integrator.save(out);
  };
  double cost = 0;
  try {
    const ScopedSeconds timed(cost);
    const WorkSection section(task_.pool, "checkpoint");
    write_checkpoint(task_.folder.file("checkpoint.bin"), identity(), save,
                     [&] { task_.stop_if_late(); });
  } catch (const Stopped&) {
    return false;
  }
  task_.phases["checkpoint"] += cost;
  checkpoints_.done(cost);
  saved_ = state_.spent;
  return true;
}

void RenderLoop::write_preview_now() {
  double cost = 0;
  {
    const ScopedSeconds timed(cost);
    const WorkSection section(task_.pool, "preview");
    write_preview(task_.folder.file("image.png"), state_.film.width(), state_.film.height(),
                  state_.film.mean());
  }
  task_.phases["preview"] += cost;
  previews_.done(cost);
}

void RenderLoop::report_progress(const Spent& spent) {
  double cost = 0;
  {
    const ScopedSeconds timed(cost);
    const WorkSection section(task_.pool, "progress");
    Progress p;
    p.iteration = static_cast<std::int64_t>(spent.iterations);
    p.seconds = spent.seconds;
    p.cpu_seconds = spent.cpu_seconds;
    p.share = share(budget_, spent);
    if (p.share > 0) p.remaining_seconds = spent.seconds * (1 - p.share) / p.share;
    const std::vector<CurveRow>& rows = state_.curve.rows();
    const auto row = std::find_if(rows.rbegin(), rows.rend(), [&](const CurveRow& r) {
      return r.iteration <= spent.iterations;
    });
    if (row != rows.rend()) {
      const ErrorMetric metric = usual_metric(row->errors.has_value());
      p.error = row->value(metric);
      p.error_metric = enum_name(metric);
    }
    task_.folder.write_progress(p);
    task_.observer.progress(p);
  }
  task_.phases["progress"] += cost;
  progress_.done(cost);
}

}  // namespace lacuna
