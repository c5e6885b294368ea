#include "jobs/run/render_loop.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <system_error>
#include <utility>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/available_memory.h"
#include "jobs/run/checkpoint.h"
#include "jobs/run/obstacle.h"
#include "jobs/spec/identity.h"
#include "jobs/spec/version.h"
#include "renderer/film/preview.h"

namespace lacuna {

namespace {

// Shares of all time that keeping watch may cost.
constexpr double checkpoint_share = 0.01;
constexpr double preview_share = 0.005;
constexpr double progress_interval = 0.5;  // seconds
constexpr double preview_interval = 1;  // seconds: what is done sooner has its picture at its end

bool is_time(double t) { return std::isfinite(t) && t >= 0; }

/// Throws std::runtime_error where the parts of a checkpoint contradict each other: its checksum
/// knows damage, not what another program wrote.
void check_saved(const Film& film, const Spent& spent, const ByteReader& in) {
  if (!in.at_end()) throw std::runtime_error("saved state has extra bytes at its end");
  if (film.iterations() != spent.iterations ||
      film.half_iterations(0) != spent.iterations - spent.iterations / 2) {
    throw std::runtime_error("saved film has another number of iterations");
  }
  if (!is_time(spent.seconds) || !is_time(spent.cpu_seconds)) {
    throw std::runtime_error("saved times are not times");
  }
}

}  // namespace

RenderLoop::RenderLoop(const RenderTask& task)
    : task_(task),
      budget_(task.spec.budget),
      film_(task.spec.resolution[0], task.spec.resolution[1]),
      frame_(task.spec.resolution[0], task.spec.resolution[1]),
      layers_(task.integrator.layers(task.spec.layers), task.spec.resolution[0],
              task.spec.resolution[1], memory_to_take()),
      clock_(task.pool.threads()),
      checkpoints_(task.spec.checkpoint_seconds, checkpoint_share),
      previews_(preview_interval, preview_share),
      progress_(progress_interval, checkpoint_share) {}

std::string RenderLoop::identity() const {
  return fmt::format("{} {} {}{}{}", picture_key(task_.spec), task_.content, version(),
                     layers_.names().empty() ? "" : " ", fmt::join(layers_.names(), " "));
}

void RenderLoop::resume() {
  const auto file = task_.folder.file("checkpoint.bin");
  try {
    const auto content = read_checkpoint(file, identity());
    if (!content) return;
    ByteReader in(*content);
    Film film(film_.width(), film_.height());
    film.load(in);
    completed_ = in.get<Spent>();
    layers_.load(in, completed_.iterations);
    counters_ = in.get<Counters>();
    curve_.load(in);
    refused_before_ = in.get<std::uint64_t>();
    task_.integrator.load(in);
    const PhaseSeconds phases = load_phases(in);
    check_saved(film, completed_, in);
    for (const auto& [name, seconds] : phases) task_.phases[name] += seconds;
    film_ = std::move(film);
    clock_.set(completed_.seconds, completed_.cpu_seconds);
    saved_ = completed_.iterations;
    report_progress();
    task_.observer.milestone(fmt::format("continuing from iteration {} ({:.1f} s)",
                                         completed_.iterations, completed_.seconds));
  } catch (const std::system_error&) {
    throw;  // the checkpoint may be good
  } catch (const std::runtime_error& e) {
    std::filesystem::rename(file, task_.folder.file("checkpoint.unusable"));
    task_.observer.warning(
        fmt::format("{}; kept as checkpoint.unusable, beginning anew", e.what()));
    layers_.clear();
    completed_ = {};
    counters_ = {};
    curve_ = {};
    refused_before_ = 0;
  }
}

std::uint64_t RenderLoop::refused_rays() const {
  return refused_before_ + task_.scene.rays().refused_rays();
}

void RenderLoop::save_phases(ByteWriter& out) const {
  out.put(static_cast<std::uint64_t>(task_.phases.size()));
  for (const auto& [name, seconds] : task_.phases) {
    out.put(std::string_view(name));
    out.put(seconds);
  }
}

PhaseSeconds RenderLoop::load_phases(ByteReader& in) {
  PhaseSeconds phases;
  for (auto n = in.get<std::uint64_t>(); n > 0; --n) {
    const std::string name(in.get_text());
    const auto seconds = in.get<double>();
    const bool follows = phases.empty() || phases.rbegin()->first < name;
    if (!follows || !is_time(seconds)) throw std::runtime_error("saved phases are not phases");
    phases[name] = seconds;
  }
  return phases;
}

bool RenderLoop::run() {
  while (!exhausted(budget_, completed_) && !would_overrun(budget_, completed_) &&
         !target_met(budget_, curve_)) {
    if (task_.interrupted() || !iterate()) {
      if (!task_.interrupted()) break;  // out of time
      write_checkpoint_now();
      report_progress();  // of what the checkpoint holds
      return false;
    }
    // An error target is looked at after each of the instants, like any other use of the error.
    if (curve_.due(completed_.seconds)) add_row();
    if (checkpoints_.due()) write_checkpoint_now();
    if (progress_.due()) report_progress();
  }
  add_row();
  write_last_checkpoint();
  report_progress();
  return true;
}

void RenderLoop::write_last_checkpoint() {
  if (saved_ == completed_.iterations) return;
  try {
    write_checkpoint_now();
  } catch (const std::system_error& e) {
    if (obstacle_of(e) != Obstacle::storage) throw;
    // The results need less room. A larger budget would go on from the checkpoint before.
    task_.observer.warning(e.what());
  }
}

bool RenderLoop::iterate() {
  const std::function<bool()> stop = [&] {
    return task_.interrupted() ||
           (completed_.iterations > 0 &&
            out_of_time(budget_, {completed_.iterations, clock_.seconds(), clock_.cpu_seconds()}));
  };
  std::fill(frame_.pixels.begin(), frame_.pixels.end(), Rgb(0, 0, 0));
  const std::span<Image> layers = layers_.begin(task_.pool);
  clock_.start();
  try {
    counters_ += task_.integrator.iterate({task_.scene, task_.camera, task_.pool, task_.spec.seed,
                                           completed_.iterations, stop, layers},
                                          frame_);
  } catch (const Stopped&) {
    clock_.stop();
    return false;
  }
  film_.add(completed_.iterations, frame_);
  clock_.stop();
  completed_ = {completed_.iterations + 1, clock_.seconds(), clock_.cpu_seconds()};
  if (!layers.empty()) {
    const ScopedSeconds timed(task_.phases["layers"]);  // no part of the estimate
    layers_.add(task_.pool);
  }
  return true;
}

void RenderLoop::add_row() {
  if (completed_.iterations == 0) return;
  double cost = 0;
  {
    const ScopedSeconds timed(cost);
    CurveRow row{completed_.iterations,
                 completed_.seconds,
                 completed_.cpu_seconds,
                 counters_,
                 std::nullopt,
                 estimated_rmse(film_),
                 false};
    if (task_.reference != nullptr) {
      row.errors = errors(film_.mean(), task_.reference->rgb);
      row.at_floor =
          task_.reference->mse && *task_.reference->mse > (*row.errors)[ErrorMetric::mse] / 2;
    }
    curve_.add(row);
    write_file_atomically(task_.folder.file("curve.csv"), curve_.csv(), false);
  }
  task_.phases["evaluate"] += cost;
  if (previews_.due()) write_preview_now();
  std::string line =
      fmt::format("iteration {}, {:.1f} s", completed_.iterations, completed_.seconds);
  for (const ErrorMetric m : {ErrorMetric::rmse, ErrorMetric::relmse, ErrorMetric::est_rmse}) {
    const auto error = curve_.rows().back().value(m);
    if (error) line += fmt::format(", {} {:.4g}", enum_name(m), *error);
  }
  if (curve_.rows().back().at_floor) line += ", at the reference's noise";
  task_.observer.milestone(line);
  if (curve_.rows().back().at_floor && !std::exchange(floor_told_, true)) {
    task_.observer.milestone(
        fmt::format("the reference's own noise, rmse {:.4g}, is more than half of the mse: errors "
                    "fall no further; a better reference shows more (reference_iterations)",
                    std::sqrt(*task_.reference->mse)));
  }
}

void RenderLoop::write_checkpoint_now() {
  double cost = 0;
  {
    const ScopedSeconds timed(cost);
    ByteWriter out;
    film_.save(out);
    out.put(completed_);
    layers_.save(out);
    out.put(counters_);
    curve_.save(out);
    out.put(refused_rays());
    task_.integrator.save(out);
    save_phases(out);
    write_checkpoint(task_.folder.file("checkpoint.bin"), identity(), out.bytes());
  }
  task_.phases["checkpoint"] += cost;
  checkpoints_.done(cost);
  saved_ = completed_.iterations;
}

void RenderLoop::write_preview_now() {
  double cost = 0;
  {
    const ScopedSeconds timed(cost);
    write_preview(task_.folder.file("image.png"), film_.width(), film_.height(), film_.mean());
  }
  task_.phases["preview"] += cost;
  previews_.done(cost);
}

void RenderLoop::report_progress() {
  double cost = 0;
  {
    const ScopedSeconds timed(cost);
    Progress p;
    p.iteration = static_cast<std::int64_t>(completed_.iterations);
    p.seconds = completed_.seconds;
    p.cpu_seconds = completed_.cpu_seconds;
    p.share = share(budget_, completed_);
    if (p.share > 0) p.remaining_seconds = completed_.seconds * (1 - p.share) / p.share;
    if (!curve_.rows().empty()) {
      const CurveRow& row = curve_.rows().back();
      const ErrorMetric metric = usual_metric(row.errors.has_value());
      p.error = row.value(metric);
      p.error_metric = enum_name(metric);
    }
    task_.folder.write_progress(p);
    task_.observer.progress(p);
  }
  task_.phases["progress"] += cost;
  progress_.done(cost);
}

}  // namespace lacuna
