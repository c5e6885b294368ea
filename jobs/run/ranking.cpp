#include "jobs/run/ranking.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "renderer/settings/error_metrics.h"

namespace lacuna {

namespace {

using PixelValues = std::vector<double>;

/// Square blocks of pixels, which average the noise of a picture's brightness.
struct Blocks {
  static constexpr int side = 16;
  int width, height;

  explicit Blocks(const Film& film) : width(film.width()), height(film.height()) {}
  int across() const { return (width + side - 1) / side; }
  std::size_t count() const {
    return std::size_t(across()) * std::size_t((height + side - 1) / side);
  }
  std::size_t of_pixel(std::size_t pixel) const {
    const int x = int(pixel) % width, y = int(pixel) / width;
    return std::size_t(y / side * across() + x / side);
  }
  /// The means over pixels and channels.
  PixelValues means(const PixelValues& rgb) const {
    PixelValues sums(count()), numbers(count());
    for (std::size_t i = 0; i < rgb.size(); ++i) {
      sums[of_pixel(i / 3)] += rgb[i];
      numbers[of_pixel(i / 3)] += 1;
    }
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] /= numbers[k];
    return sums;
  }
};

/// The lower median of a pixel over the pictures, robust to an outlier of one; 0 for one picture.
double lower_median(const std::vector<PixelValues>& pictures, std::size_t i) {
  if (pictures.size() < 2) return 0;
  PixelValues all;
  for (const PixelValues& p : pictures) all.push_back(p[i]);
  const auto middle = all.begin() + std::ptrdiff_t((all.size() - 1) / 2);
  std::nth_element(all.begin(), middle, all.end());
  return *middle;
}

/// The scale of comparison: the mean brightness of each block over all pictures, and the divisors
/// of squared errors, per block and per value of a pixel.
struct Scale {
  PixelValues brightness, block_divisor, divisor;

  Scale(const Blocks& blocks, const std::vector<PixelValues>& means,
        const std::vector<PixelValues>& block_means, RankingMetric metric)
      : brightness(blocks.count()),
        block_divisor(blocks.count(), 1),
        divisor(means.front().size(), 1) {
    for (std::size_t k = 0; k < brightness.size(); ++k) {
      for (const PixelValues& m : block_means) brightness[k] += m[k] / double(block_means.size());
    }
    if (metric == RankingMetric::mse) return;
    for (std::size_t k = 0; k < brightness.size(); ++k) block_divisor[k] = over(brightness[k]);
    for (std::size_t i = 0; i < divisor.size(); ++i) {
      const double block = brightness[blocks.of_pixel(i / 3)];
      divisor[i] = over(std::max(block, lower_median(means, i)));
    }
  }

  double distance(const PixelValues& a, const PixelValues& b) const {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += squared_error(a[i], b[i]) / divisor[i];
    return sum / double(a.size());
  }
  double missing(const PixelValues& block_means) const {
    double sum = 0;
    for (std::size_t k = 0; k < brightness.size(); ++k) {
      if (block_means[k] >= brightness[k] / 2) continue;
      sum += squared_error(block_means[k], brightness[k]) / block_divisor[k];
    }
    return sum / double(brightness.size());
  }

 private:
  static double over(double r) { return r * r + 0.01; }
};

bool is_dark(const PixelValues& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return v == 0; });
}

/// The noise of a picture from its halves; none before each has an iteration.
std::optional<double> noise_from_halves(const Film& film, const Scale& scale) {
  const auto even = double(film.half_iterations(0)), odd = double(film.half_iterations(1));
  if (even == 0 || odd == 0) return std::nullopt;
  return scale.distance(film.half_mean(0), film.half_mean(1)) * scale_from_halves(even, odd);
}

/// The noise of picture `k` from its distances to the others.
std::optional<double> noise_from_others(const std::vector<PixelValues>& means, std::size_t k,
                                        const Scale& scale) {
  std::vector<std::pair<double, std::size_t>> others;
  for (std::size_t j = 0; j < means.size(); ++j) {
    if (j != k && !is_dark(means[j])) others.emplace_back(scale.distance(means[k], means[j]), j);
  }
  if (others.size() < 2) return std::nullopt;
  std::partial_sort(others.begin(), others.begin() + 2, others.end());
  const auto& [near, y] = others[0];
  const auto& [far, z] = others[1];
  return std::max((near + far - scale.distance(means[y], means[z])) / 2, near / 16);
}

}  // namespace

std::vector<std::optional<PictureError>> picture_errors(std::span<const CandidatePicture> pictures,
                                                        RankingMetric metric) {
  const Blocks blocks(*pictures.front().film);
  std::vector<PixelValues> means, block_means;
  for (const CandidatePicture& p : pictures) {
    means.push_back(p.film->mean());
    block_means.push_back(blocks.means(means.back()));
  }
  const Scale scale(blocks, means, block_means, metric);
  const bool all_dark = std::all_of(means.begin(), means.end(), is_dark);

  std::vector<std::optional<PictureError>> errors(pictures.size());
  std::optional<std::size_t> best;  // unbiased
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    if (!all_dark && is_dark(means[k])) continue;
    auto noise = noise_from_halves(*pictures[k].film, scale);
    if (!noise) noise = noise_from_others(means, k, scale);
    if (!noise) continue;
    errors[k] = {.noise = *noise, .missing = scale.missing(block_means[k])};
    if (!pictures[k].biased && (!best || *noise < errors[*best]->noise)) best = k;
  }
  for (std::size_t k = 0; k < pictures.size() && best; ++k) {
    if (!pictures[k].biased || !errors[k]) continue;
    const double apart = scale.distance(means[k], means[*best]);
    errors[k]->bias = std::max(0.0, apart - errors[k]->noise - errors[*best]->noise);
  }
  return errors;
}

std::vector<std::size_t> better_half(std::span<const std::optional<double>> errors,
                                     const std::vector<bool>& biased, bool has_default) {
  std::vector<double> known;
  for (const auto& e : errors) known.push_back(e.value_or(std::numeric_limits<double>::infinity()));
  if (has_default) known.front() *= default_advantage;
  std::vector<std::size_t> order(errors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return known[a] < known[b]; });
  const std::size_t kept = (errors.size() + 1) / 2;
  // Moves the best candidate that `belongs` among the kept, in place of the worst except `spared`.
  const auto keep = [&](const auto& belongs, std::size_t spared) {
    const auto found = std::find_if(order.begin(), order.end(), belongs);
    const auto end = order.begin() + std::ptrdiff_t(kept);
    if (found < end || found == order.end()) return;
    std::swap(*found, *(*(end - 1) == spared ? end - 2 : end - 1));
  };
  if (kept > 1) {
    const auto best = std::find_if(order.begin(), order.end(), [&](auto k) { return !biased[k]; });
    const std::size_t yardstick = best == order.end() ? order.size() : *best;
    keep([&](std::size_t k) { return k == yardstick; }, order.size());
    if (has_default) keep([](std::size_t k) { return k == 0; }, yardstick);
  }
  order.resize(kept);
  std::sort(order.begin(), order.end());
  return order;
}

}  // namespace lacuna
