#include "jobs/run/foreign_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>

#include "base/json/json_text.h"
#include "base/storage/atomic_file.h"
#include "jobs/run/foreign_program.h"
#include "jobs/run/input_check.h"
#include "jobs/run/job_reference.h"
#include "jobs/run/machine_watch.h"
#include "jobs/run/report_parts.h"
#include "jobs/run/results.h"
#include "jobs/spec/job_json.h"
#include "jobs/spec/version.h"
#include "jobs/store/own_document.h"
#include "jobs/sweep/estimate.h"
#include "renderer/film/block_statistics.h"
#include "renderer/film/flip.h"
#include "renderer/images/image_read.h"

namespace lacuna {

/// A picture on disk and its render time: measured.json, next to those that a command has rendered.
struct TimedPicture {
  std::string file;  ///< a path; in measured.json a name in the folder
  double seconds = 0;
  double cpu_seconds = std::numeric_limits<double>::quiet_NaN();  ///< divided by threads
  std::string input = {};  ///< its name in the job, if it is an input
};
template <class V>
void describe(V& v, TimedPicture& s) {
  v("file", s.file, {.doc = "name in the folder", .min = 1, .max = 100, .required = true});
  v("seconds", s.seconds, {.doc = "render time", .min = 0, .required = true, .unit = "s"});
  v("cpu_seconds", s.cpu_seconds,
    {.doc = "CPU seconds divided by threads", .min = 0, .required = true, .unit = "s"});
}
struct MeasuredPictures {
  std::vector<TimedPicture> pictures;
};
template <class V>
void describe(V& v, MeasuredPictures& s) {
  v("pictures", s.pictures, {.doc = "pictures in the folder", .required = true});
}

namespace {

namespace fs = std::filesystem;

class ForeignRun {
 public:
  ForeignRun(const JobFolder& folder, const JobSpec& spec, const RunContext& context,
             Running& running)
      : folder_(folder),
        spec_(spec),
        settings_(std::get<ForeignSettings>(spec.integrator)),
        context_(context),
        running_(running) {}

  Outcome run() {
    prepared_ = prepare(spec_, context_);
    for (const std::string& w : prepared_.warnings) running_.warn(w);
    if (!spec_.reference.empty()) {
      running_.phase("reference");
      reference_ = job_reference(folder_, spec_, prepared_, context_);
      if (!reference_) return Outcome::interrupted;
      if (spec_.reference != "auto") prepared_.inputs.push_back(reference_->input);
    }
    running_.phase("rendering");
    const MachineWatch watch;
    const std::vector<TimedPicture> pictures = settings_.command.empty() ? named() : rendered();
    const auto disturbance = watch.disturbance();
    FloatImage last;
    for (const TimedPicture& p : pictures) last = add(p);
    running_.phase("writing");
    write_inputs(folder_, prepared_.inputs);
    if (pictures.empty()) {
      running_.warn(fmt::format("\"pictures\" has none of seed {}", spec_.seed));
    } else {
      write(last);
    }
    write_file_atomically(folder_.file("curve.csv"), curve_.csv());
    write_report(disturbance);
    return Outcome::done;
  }

 private:
  Placeholders common() const {
    return {{"scene", fs::path(spec_.scene).stem().string()},
            {"seed", fmt::format("{}", spec_.seed)}};
  }

  /// The pictures that the job names for its seed.
  std::vector<TimedPicture> named() {
    std::vector<TimedPicture> found;
    for (const ForeignPicture& p : settings_.pictures) {
      const bool every = p.file.find("{seed}") != std::string::npos;
      if (p.seed ? *p.seed != spec_.seed : !every && spec_.seed != 1) continue;
      const std::string name = fill_in(p.file, common());
      const fs::path file = reference_file(name, context_.data, context_.scenes, "picture");
      found.push_back({file.string(), p.seconds,
                       p.cpu_seconds.value_or(std::numeric_limits<double>::quiet_NaN()), name});
    }
    sort(found);
    return found;
  }

  /// The pictures of the command, which is run for those that the folder does not have.
  std::vector<TimedPicture> rendered() {
    const fs::path record = folder_.file("measured.json");
    MeasuredPictures done;
    if (fs::exists(record)) {
      const auto earlier = read_inputs(folder_);
      if (earlier) refuse_changed_inputs(folder_, changed_inputs(*earlier, prepared_.inputs));
      done = read_own<MeasuredPictures>(record);
    }
    write_inputs(folder_, prepared_.inputs);
    std::vector<double> times = settings_.seconds;
    if (times.empty())
      times = {spec_.budget.seconds.value_or(spec_.budget.cpu_seconds.value_or(0))};
    while (done.pictures.size() < times.size()) {
      done.pictures.push_back(render(times, done.pictures.size()));
      write_file_atomically(record, write_document(done));
    }
    for (TimedPicture& p : done.pictures) p.file = folder_.file(p.file).string();
    sort(done.pictures);
    return done.pictures;
  }

  TimedPicture render(const std::vector<double>& times, std::size_t index) {
    const int threads = prepared_.pool->threads();
    const std::string name = fmt::format("picture-{}.{}", index + 1, enum_name(settings_.format));
    Placeholders values = common();
    values["scene"] = context_.scenes.resolve(spec_.scene, scene_extensions).string();
    values["out"] = fs::absolute(folder_.file(name)).string();
    values["camera"] = prepared_.camera_name;
    values["width"] = fmt::format("{}", spec_.resolution[0]);
    values["height"] = fmt::format("{}", spec_.resolution[1]);
    values["max_depth"] = fmt::format("{}", settings_.max_depth);
    values["seconds"] = fmt::format("{:g}", times[index]);
    values["threads"] = fmt::format("{}", threads);
    report_progress(index, times.size());
    const ProgramTime time =
        run_program(settings_, values, folder_.file("program.log"), context_.interrupted);
    if (!fs::exists(folder_.file(name))) {
      throw SceneError(fmt::format("\"{}\" ended without writing {}; its output is in {}",
                                   settings_.command.front(), folder_.file(name).string(),
                                   folder_.file("program.log").string()));
    }
    const double seconds = time.seconds - settings_.start.seconds,
                 cpu_seconds = time.cpu_seconds / threads - settings_.start.cpu_seconds;
    if (seconds <= 0 || cpu_seconds <= 0) {
      throw SceneError(fmt::format(
          "\"start\" of {:g} and {:g} CPU seconds is not below the {:.3f} and {:.3f} of the whole "
          "program",
          settings_.start.seconds, settings_.start.cpu_seconds, time.seconds,
          time.cpu_seconds / threads));
    }
    context_.observer.milestone(fmt::format("{}: {:.1f} s, {:.1f} CPU s on each of {} threads",
                                            settings_.program, seconds, cpu_seconds, threads));
    return {name, seconds, cpu_seconds, {}};
  }

  static void sort(std::vector<TimedPicture>& pictures) {
    std::sort(pictures.begin(), pictures.end(),
              [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
  }

  void report_progress(std::size_t done, std::size_t all) {
    Progress p;
    p.share = double(done) / double(all);
    folder_.write_progress(p);
    context_.observer.progress(p);
  }

  /// Adds a picture's errors to the curve.
  FloatImage add(const TimedPicture& p) {
    FloatImage image = read_reference_image(p.file, settings_.layer);
    if (image.width != spec_.resolution[0] || image.height != spec_.resolution[1]) {
      throw SceneError(fmt::format("{} has {} x {} pixels, but the job has {} x {}", p.file,
                                   image.width, image.height, spec_.resolution[0],
                                   spec_.resolution[1]));
    }
    require_finite(image, p.file);
    if (!p.input.empty()) {
      prepared_.inputs.push_back(image.file);
      prepared_.inputs.back().role = InputRole::picture;
      prepared_.inputs.back().name = p.input;
    }
    if (image.least_alpha && *image.least_alpha < 1) {
      running_.warn(fmt::format(
          "{} has alpha from {:g}: its colours are taken as they are, without a background", p.file,
          *image.least_alpha));
    }
    CurveRow row;
    row.seconds = p.seconds;
    row.longest_seconds = p.seconds;
    row.cpu_seconds = p.cpu_seconds;
    if (reference_) {
      const std::vector<double> rgb(image.rgb.begin(), image.rgb.end());
      row.errors = errors(rgb, reference_->rgb);
      if (!flip_exposures_) flip_exposures_ = flip_exposures(reference_->rgb);
      row.flip = flip_mean(hdr_flip({rgb, reference_->rgb, image.width, image.height},
                                    *flip_exposures_, prepared_.pool.get()));
      row.at_floor = reference_->mse && *reference_->mse > (*row.errors)[ErrorMetric::mse] / 2;
      compare_means(p.file, rgb);
    }
    curve_.add(row);
    return image;
  }

  /// Warns if the picture's mean differs from the reference's by more than noise. The noise is
  /// that of block means, so that it includes correlation between neighbouring pixels.
  void compare_means(const std::string& file, std::span<const double> rgb) {
    constexpr int side = 16;
    constexpr double most_deviations = 4, least_difference = 1e-3;
    if (std::min(spec_.resolution[0], spec_.resolution[1]) < side) return;
    const BlockStatistics blocks = block_statistics(
        {rgb, reference_->rgb, {}, spec_.resolution[0], spec_.resolution[1]}, side);
    const double expected = mean(reference_->rgb).value, difference = mean(rgb).value - expected;
    const double deviation = blocks.rms / std::sqrt(blocks.blocks);
    if (std::abs(difference) < most_deviations * deviation) return;
    if (std::abs(difference) < least_difference * std::abs(expected)) return;
    running_.warn(fmt::format(
        "{}: its mean is {:+.2f} % off the reference's, {:.1f} standard deviations of its noise: "
        "another exposure, filter, path length or scene?",
        file, 100 * difference / expected, std::abs(difference) / deviation));
  }

  void write(const FloatImage& image) const {
    write_pictures(folder_,
                   {image.width,
                    image.height,
                    {{"", {"R", "G", "B"}, {image.rgb.begin(), image.rgb.end()}}},
                    spec_.pixel_type,
                    {{"version", version()},
                     {"job", folder_.id()},
                     {"spec", lacuna::write_job(spec_)},
                     {"seconds", fmt::format("{:.3f}", curve_.rows().back().seconds)}}},
                   reference_ ? &*reference_ : nullptr, [] {});
  }

  void write_report(const std::optional<Disturbance>& disturbance) const {
    OrderedJson j;
    j["version"] = version();
    j["job"] = folder_.id();
    if (!settings_.command.empty()) j["seconds"]["load"] = settings_.start.seconds;
    if (!curve_.rows().empty()) {
      const CurveRow& row = curve_.rows().back();
      j["seconds"]["render"] = row.seconds;
      if (!std::isnan(row.cpu_seconds)) j["seconds"]["render_cpu"] = row.cpu_seconds;
      for (const ErrorMetricRow& metric : error_metrics) {
        if (const auto v = row.value(metric.value)) j["errors"][std::string(metric.name)] = *v;
      }
      if (reference_) j["errors"]["reference"] = reference_json(*reference_, row.at_floor);
    }
    j["scene"] = {{"camera", prepared_.camera_name}};
    j["warnings"] = running_.warnings();
    j["machine"] = machine_json(prepared_.pool->threads(),
                                settings_.command.empty() ? std::nullopt : disturbance);
    write_file_atomically(folder_.file("report.json"), document_text(j));
  }

  const JobFolder& folder_;
  const JobSpec& spec_;
  const ForeignSettings& settings_;
  const RunContext& context_;
  Running& running_;
  Prepared prepared_;
  std::optional<Reference> reference_;
  std::optional<FlipExposures> flip_exposures_;  // of the reference
  Curve curve_;
};

}  // namespace

Outcome run_foreign(const JobFolder& folder, const JobSpec& spec, const RunContext& context,
                    Running& running) {
  return ForeignRun(folder, spec, context, running).run();
}

}  // namespace lacuna
