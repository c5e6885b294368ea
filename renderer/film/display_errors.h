#pragma once

#include <span>

namespace lacuna {

/// The difference of two pictures as displayed: sRGB codes of 0 to 255, at one exposure.
struct DisplayErrors {
  double mse = 0;   ///< over pixels and channels
  double psnr = 0;  ///< 10 log10(255^2 / mse), dB; infinite for equal pictures
  double ssim =
      0;  ///< structural similarity of luma, windows of 11 x 11 (Wang et al. 2004); 1: same
};

/// `estimate` and `reference`: interleaved linear RGB of `width` x `height` pixels, both sides
/// above 0. `exposure`: as in preview_png(). Throws std::invalid_argument for other sizes.
DisplayErrors display_errors(std::span<const double> estimate, std::span<const double> reference,
                             int width, int height, double exposure);

}  // namespace lacuna
