#include "renderer/film/film.h"

#include <algorithm>

#include "renderer/film/saved_values.h"

namespace lacuna {

Film::Film(int width, int height) : width_(width), height_(height) {
  const std::size_t n = 3 * std::size_t(width) * std::size_t(height);
  for (Half& h : halves_) {
    h.mean.assign(n, 0.0);
    h.m2.assign(n, 0.0);
  }
}

void Film::add(std::uint64_t iteration, const Image& estimate) {
  Half& h = halves_[iteration % 2];
  ++h.n;
  const double share = 1.0 / static_cast<double>(h.n);
  SquaredErrors::Sums sums{};
  std::size_t i = 0;
  for (int y = 0; y < height_; ++y) {
    double* row = &sums[std::size_t(y % SquaredErrors::side) * SquaredErrors::side];
    for (int x = 0; x < width_; ++x) {
      const Rgb& pixel = estimate.pixels[i / 3];
      double squares = 0;
      for (const float v : {pixel.x, pixel.y, pixel.z}) {
        const double deviation = double(v) - h.mean[i];
        h.mean[i] += deviation * share;
        const double square = deviation * (double(v) - h.mean[i]);
        h.m2[i] += square;
        squares += square;
        ++i;
      }
      row[x % SquaredErrors::side] += squares;
    }
  }
  if (h.n < 2) return;
  for (double& sum : sums) sum /= 3;  // channels
  squared_errors_.add(sums, width_, height_);
}

std::vector<double> Film::mean() const {
  const auto n = static_cast<double>(std::max<std::uint64_t>(1, iterations()));
  const double even = static_cast<double>(halves_[0].n) / n;
  const double odd = static_cast<double>(halves_[1].n) / n;
  std::vector<double> mean(halves_[0].mean.size());
  for (std::size_t i = 0; i < mean.size(); ++i) {
    mean[i] = even * halves_[0].mean[i] + odd * halves_[1].mean[i];
  }
  return mean;
}

std::vector<double> Film::variance_of_mean() const {
  std::vector<double> variance(halves_[0].mean.size(), 0.0);
  const auto n = static_cast<double>(iterations());
  if (n < 2) return variance;
  // Deviations of the union of two sets (Chan, Golub and LeVeque 1979).
  const double between = static_cast<double>(halves_[0].n) * static_cast<double>(halves_[1].n) / n;
  for (std::size_t i = 0; i < variance.size(); ++i) {
    const double d = halves_[0].mean[i] - halves_[1].mean[i];
    const double m2 = halves_[0].m2[i] + halves_[1].m2[i] + d * d * between;
    variance[i] = m2 / (n - 1) / n;
  }
  return variance;
}

void Film::save(ByteWriter& out) const {
  out.put(width_);
  out.put(height_);
  for (const Half& h : halves_) {
    out.put(h.n);
    out.put(h.mean);
    out.put(h.m2);
  }
  squared_errors_.save(out);
}

void Film::load(ByteReader& in) {
  if (in.get<int>() != width_ || in.get<int>() != height_) {
    throw std::runtime_error("saved film has another size");
  }
  const std::size_t size = halves_[0].mean.size();
  for (Half& h : halves_) {
    h.n = in.get<std::uint64_t>();
    h.mean = get_finite(in, size, "film");
    h.m2 = get_finite(in, size, "film");
  }
  squared_errors_.load(in);
}

}  // namespace lacuna
