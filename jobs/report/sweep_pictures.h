#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "jobs/run/reference.h"
#include "jobs/sweep/answers.h"

namespace lacuna {

/// A crop of a cell's last picture.
struct CellCrop {
  std::size_t cell;  ///< index into plan().cells
  double seconds;    ///< render time of the picture
  std::string png;
};

/// The same crop, at the same exposure, of all cells that estimate one picture: at most
/// 96 x 96 pixels, where the errors of the cells differ most (CropSelection).
struct PictureCrops {
  std::size_t picture;  ///< index into Answers::pictures
  int x = 0, y = 0, width = 0, height = 0;
  std::optional<std::string> reference_png;
  std::vector<CellCrop> cells;  ///< of each cell its first finished run
};

/// Results that need the pixels.
struct SweepPictures {
  std::vector<PictureCrops> crops;
  /// For each cell of the plan the bias between its replicates (jobs/report/replicate_bias.h), if
  /// it has two or more and its reference still exists.
  std::vector<std::optional<Estimate>> bias_squared;
  std::vector<std::string> warnings;  ///< pictures that could not be read
};

/// The last picture of a run, an index into plan().runs: three values for each pixel, top row
/// first. Throws SceneError, InputUnreadable.
std::vector<double> read_picture(const SweepFolder& sweep, std::size_t run);

/// The reference of cells of one picture: that of the first finished run with one that still
/// exists. Throws as read_picture().
std::optional<Reference> read_reference_of(const SweepFolder& sweep, const Answers& answers,
                                           std::span<const std::size_t> cells);

/// Reads the pictures of all finished runs, one at a time.
SweepPictures look_at_pictures(const SweepFolder& sweep, const Answers& answers);

}  // namespace lacuna
