#include "jobs/report/sweep_pictures.h"

#include <fmt/format.h>

#include <map>
#include <stdexcept>

#include "jobs/report/crop_selection.h"
#include "jobs/report/replicate_bias.h"
#include "renderer/core/scene_error.h"
#include "renderer/film/preview.h"
#include "renderer/images/image_read.h"

namespace lacuna {
namespace {

using Pixels = std::vector<double>;

constexpr int crop_side = 96;

/// All cells of one picture.
class PictureReader {
 public:
  PictureReader(const SweepFolder& sweep, const Answers& answers, std::size_t picture,
                SweepPictures& out)
      : sweep_(sweep),
        answers_(answers),
        picture_(picture),
        out_(out),
        crops_(resolution(), crop_side),
        width_(resolution()[0]) {}

  void run() {
    const auto& cells = answers_.pictures[picture_].cells;
    warning([&] { reference_ = read_reference_of(sweep_, answers_, cells); });
    for (const std::size_t c : cells) read_cell(answers_.cells[c]);
    if (!firsts_.empty()) cut_crops();
  }

 private:
  const std::array<int, 2>& resolution() const {
    return sweep_.plan().cells[answers_.pictures[picture_].cells.front()].job.resolution;
  }

  /// Reports files that cannot be read.
  template <class Read>
  void warning(const Read& read) {
    try {
      read();
    } catch (const std::runtime_error& e) {
      out_.warnings.emplace_back(e.what());
    }
  }

  std::optional<Pixels> read(std::size_t run) {
    std::optional<Pixels> pixels;
    warning([&] { pixels = read_picture(sweep_, run); });
    return pixels;
  }

  void read_cell(const CellAnswer& cell) {
    std::optional<ReplicateBias> bias;
    if (reference_ && cell.done.size() > 1) bias.emplace(reference_->rgb, width_);
    for (const std::size_t run : cell.done) {
      if (run != cell.done.front() && !bias) break;
      const auto pixels = read(run);
      if (!pixels) continue;
      if (bias) bias->add(*pixels);
      if (!firsts_.emplace(cell.cell, run).second) continue;
      crops_.add(*pixels, reference_ ? reference_->rgb : Pixels());
    }
    if (bias) out_.bias_squared[cell.cell] = bias->bias_squared(reference_->mse);
  }

  void cut_crops() {
    const PixelRect r = crops_.choose(1).front();
    double exposure = reference_ ? preview_exposure(cut(reference_->rgb, width_, r)) : 0;
    const auto png = [&](const Pixels& part) {
      if (exposure == 0) exposure = preview_exposure(part);
      return preview_png(r.width, r.height, part, exposure);
    };
    PictureCrops crops{picture_, r.x, r.y, r.width, r.height, {}, {}};
    if (reference_) crops.reference_png = png(cut(reference_->rgb, width_, r));
    for (const auto& [cell, run] : firsts_) {
      // Read again: all at once might not fit into memory.
      const auto pixels = read(run);
      if (!pixels) continue;
      crops.cells.push_back({cell, answers_.results[run].end->time, png(cut(*pixels, width_, r))});
    }
    out_.crops.push_back(std::move(crops));
  }

  const SweepFolder& sweep_;
  const Answers& answers_;
  const std::size_t picture_;
  SweepPictures& out_;
  std::optional<Reference> reference_;
  std::map<std::size_t, std::size_t> firsts_;  // run, by cell
  CropSelection crops_;
  int width_;
};

}  // namespace

std::vector<double> read_picture(const SweepFolder& sweep, std::size_t run) {
  const SweepRun& of = sweep.plan().runs[run];
  const std::filesystem::path file = sweep.folder(of).file("image.exr");
  const FloatImage image = read_float_image(file);
  const auto& [width, height] = sweep.plan().cells[of.cell].job.resolution;
  if (image.width != width || image.height != height) {
    throw SceneError(fmt::format("{} has {} x {} pixels, but its job {} x {}", file.string(),
                                 image.width, image.height, width, height));
  }
  return {image.rgb.begin(), image.rgb.end()};
}

std::optional<Reference> read_reference_of(const SweepFolder& sweep, const Answers& answers,
                                           std::span<const std::size_t> cells) {
  for (const std::size_t c : cells) {
    for (const std::size_t run : answers.cells[c].done) {
      const auto& file = answers.results[run].reference_file;
      if (!file || !std::filesystem::exists(*file)) continue;
      const JobSpec& job = sweep.plan().cells[c].job;
      return read_reference(job.reference, *file, job.resolution);
    }
  }
  return {};
}

SweepPictures look_at_pictures(const SweepFolder& sweep, const Answers& answers) {
  SweepPictures out;
  out.bias_squared.resize(answers.cells.size());
  for (std::size_t p = 0; p < answers.pictures.size(); ++p) {
    PictureReader(sweep, answers, p, out).run();
  }
  return out;
}

}  // namespace lacuna
