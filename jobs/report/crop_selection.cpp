#include "jobs/report/crop_selection.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numeric>

#include "renderer/settings/error_metrics.h"

namespace lacuna {
namespace {

double relative_error(const std::vector<double>& x, const std::vector<double>& r) {
  // The median of the pixels' terms would miss fireflies, the mean sees little else: a mean of
  // roots lies between.
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sum += std::sqrt(row_of(ErrorMetric::relmse).term(x[i], r[i]));
  }
  return sum / static_cast<double>(x.size());
}

}  // namespace

CropSelection::CropSelection(const std::array<int, 2>& resolution, int side)
    : resolution_(resolution), grid_(crop_grid(resolution[0], resolution[1], side, side)) {}

void CropSelection::add(const std::vector<double>& picture, const std::vector<double>& reference) {
  if (reference.empty() && first_.empty()) {
    first_ = picture;
    return;
  }
  const std::vector<double>& other = reference.empty() ? first_ : reference;
  auto& own = errors_.emplace_back();
  for (const PixelRect& c : grid_) {
    own.push_back(relative_error(cut(picture, resolution_[0], c), cut(other, resolution_[0], c)));
  }
}

std::vector<PixelRect> CropSelection::choose(std::size_t count) const {
  if (errors_.empty()) return {grid_[grid_.size() / 2]};
  std::vector<double> spread;
  for (std::size_t i = 0; i < grid_.size(); ++i) {
    const auto here = [i](const auto& a, const auto& b) { return a[i] < b[i]; };
    const auto [low, high] = std::minmax_element(errors_.begin(), errors_.end(), here);
    spread.push_back((*high)[i] - (errors_.size() > 1 ? (*low)[i] : 0));
  }
  std::vector<std::size_t> order(grid_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t i) { return spread[i]; });
  std::vector<PixelRect> found;
  for (const std::size_t i : order) {
    if (found.size() == count) break;
    const auto touches = [&, &own = grid_[i]](const PixelRect& c) {
      return std::abs(c.x - own.x) < c.width && std::abs(c.y - own.y) < c.height;
    };
    if (std::ranges::none_of(found, touches)) found.push_back(grid_[i]);
  }
  return found;
}

}  // namespace lacuna
