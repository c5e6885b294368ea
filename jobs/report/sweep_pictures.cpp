#include "jobs/report/sweep_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "jobs/report/replicate_bias.h"
#include "jobs/run/reference.h"
#include "renderer/film/crop.h"
#include "renderer/film/preview.h"
#include "renderer/geometry/scene_data.h"
#include "renderer/images/image_read.h"

namespace lacuna {
namespace {

using Pixels = std::vector<double>;

constexpr int crop_side = 96;

/// Squared errors of a picture in each of a grid's rectangles.
std::vector<double> errors_of(const std::vector<PixelRect>& grid, const Pixels& picture,
                              const Pixels& reference, int width) {
  std::vector<double> sums;
  for (const PixelRect& r : grid) {
    const Pixels a = cut(picture, width, r), b = cut(reference, width, r);
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    sums.push_back(sum);
  }
  return sums;
}

/// All cells of one picture.
class PictureReader {
 public:
  PictureReader(const SweepFolder& sweep, const Answers& answers, std::size_t picture,
                SweepPictures& out)
      : sweep_(sweep), answers_(answers), picture_(picture), out_(out) {}

  void run() {
    for (const std::size_t c : answers_.pictures[picture_].cells) read_cell(answers_.cells[c]);
    if (!firsts_.empty()) cut_crops();
  }

 private:
  std::optional<FloatImage> read(std::size_t run) {
    const auto file = sweep_.folder(sweep_.plan().runs[run]).file("image.exr");
    try {
      return read_float_image(file);
    } catch (const std::runtime_error& e) {
      out_.warnings.emplace_back(e.what());
      return {};
    }
  }

  /// Reads the reference of a run, unless one was read before.
  void find_reference(std::size_t run) {
    const auto& file = answers_.results[run].reference_file;
    if (reference_ || !file || *file == tried_) return;
    tried_ = *file;
    const auto& job = sweep_.plan().cells[sweep_.plan().runs[run].cell].job;
    try {
      reference_ = read_reference(job.reference, *file, job.resolution);
    } catch (const std::runtime_error& e) {
      out_.warnings.push_back(fmt::format("no reference: {}", e.what()));
    }
  }

  void read_cell(const CellAnswer& cell) {
    std::optional<ReplicateBias> bias;
    for (const std::size_t run : cell.done) {
      find_reference(run);
      if (run != cell.done.front() && (!reference_ || cell.done.size() < 2)) break;
      const auto image = read(run);
      if (!image) continue;
      if (reference_ && !bias) bias.emplace(reference_->rgb, image->width);
      const Pixels pixels(image->rgb.begin(), image->rgb.end());
      if (bias) bias->add(pixels);
      if (firsts_.emplace(cell.cell, run).second) note_errors(pixels, image->width, image->height);
    }
    if (bias) out_.bias_squared[cell.cell] = bias->bias_squared(reference_->mse);
  }

  void note_errors(const Pixels& pixels, int width, int height) {
    if (grid_.empty()) grid_ = crop_grid(width, height, crop_side, crop_side);
    width_ = width;
    if (reference_) errors_.push_back(errors_of(grid_, pixels, reference_->rgb, width));
  }

  PixelRect choose_crop() const {
    if (errors_.empty()) return grid_[grid_.size() / 2];
    std::size_t best = 0;
    double largest = -1;
    for (std::size_t i = 0; i < grid_.size(); ++i) {
      std::vector<double> errors;
      for (const auto& e : errors_) errors.push_back(e[i]);
      const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
      std::nth_element(errors.begin(), middle, errors.end());
      if (*middle <= largest) continue;
      largest = *middle;
      best = i;
    }
    return grid_[best];
  }

  void cut_crops() {
    const PixelRect r = choose_crop();
    double exposure = reference_ ? preview_exposure(cut(reference_->rgb, width_, r)) : 0;
    const auto png = [&](const Pixels& part) {
      if (exposure == 0) exposure = preview_exposure(part);
      return preview_png(r.width, r.height, part, exposure);
    };
    PictureCrops crops{picture_, r.x, r.y, r.width, r.height, {}, {}};
    if (reference_) crops.reference_png = png(cut(reference_->rgb, width_, r));
    for (const auto& [cell, run] : firsts_) {
      // Read again: all at once might not fit into memory.
      const auto image = read(run);
      if (!image) continue;
      const Pixels pixels(image->rgb.begin(), image->rgb.end());
      crops.cells.push_back({cell, answers_.results[run].end->time, png(cut(pixels, width_, r))});
    }
    out_.crops.push_back(std::move(crops));
  }

  const SweepFolder& sweep_;
  const Answers& answers_;
  const std::size_t picture_;
  SweepPictures& out_;
  std::optional<Reference> reference_;
  std::string tried_;
  std::map<std::size_t, std::size_t> firsts_;  // run, by cell
  std::vector<PixelRect> grid_;
  std::vector<std::vector<double>> errors_;  // of each first run, in the grid
  int width_ = 0;
};

}  // namespace

SweepPictures look_at_pictures(const SweepFolder& sweep, const Answers& answers) {
  SweepPictures out;
  out.bias_squared.resize(answers.cells.size());
  for (std::size_t p = 0; p < answers.pictures.size(); ++p) {
    PictureReader(sweep, answers, p, out).run();
  }
  return out;
}

}  // namespace lacuna
