#include "renderer/path/reflected_radiance.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lacuna {

ReflectedRadiance::ReflectedRadiance(const V3d& low, const V3d& size) : low_(low) {
  const double longest = std::max({size.x, size.y, size.z});
  scale_ = longest > 0 ? side / longest : 0;
  known_.assign(std::size_t{sides} * side * side * side, {});
  learning_ = known_;
  make_means();
}

std::size_t ReflectedRadiance::index(const V3f& x, const V3f& n) const {
  int longest = std::abs(n.y) > std::abs(n.x) ? 1 : 0;
  if (std::abs(n.z) > std::abs(n[longest])) longest = 2;
  auto i = static_cast<std::size_t>(2 * longest + (n[longest] < 0 ? 1 : 0));
  const V3d p = (V3d(x) - low_) * scale_;
  for (int axis = 0; axis < 3; ++axis) {
    i = i * side + static_cast<std::size_t>(std::clamp(p[axis], 0.0, side - 1.0));
  }
  return i;
}

void ReflectedRadiance::update(const TrainingSamples& samples) {
  for (const TrainingSample& s : samples.all())
    learning_[index(s.x, s.n)] += {double(s.reflected), 1};
  if (!rounds_.add(samples.share())) return;
  std::swap(known_, learning_);
  std::fill(learning_.begin(), learning_.end(), Samples{});
  make_means();
}

std::size_t ReflectedRadiance::above(std::size_t i, std::size_t level) {
  const std::size_t bits = levels - 1 - level, mask = (std::size_t{1} << bits) - 1;
  const std::size_t z = i & mask, y = i >> bits & mask, x = i >> 2 * bits & mask;
  const std::size_t face = i >> 3 * bits;
  return ((face << (bits - 1) | x >> 1) << (bits - 1) | y >> 1) << (bits - 1) | z >> 1;
}

void ReflectedRadiance::make_means() {
  std::array<std::vector<Samples>, levels> sums;
  sums[0] = known_;
  for (std::size_t level = 1; level < levels; ++level) {
    const std::vector<Samples>& below = sums[level - 1];
    sums[level].resize(below.size() / 8);
    for (std::size_t i = 0; i < below.size(); ++i) sums[level][above(i, level - 1)] += below[i];
  }
  Samples all;
  for (const Samples& s : sums[levels - 1]) all += s;
  samples_ = all.samples;
  means_.assign(1, all.mean());
  for (std::size_t level = levels; level-- > 0;) {
    const std::vector<Samples>& here = sums[level];
    std::vector<float> found(here.size());
    for (std::size_t i = 0; i < here.size(); ++i) {
      const bool enough = here[i].samples >= least_samples;
      found[i] = enough ? here[i].mean() : means_[level + 1 < levels ? above(i, level) : 0];
    }
    means_ = std::move(found);
  }
}

void ReflectedRadiance::save(ByteWriter& out) const {
  out.put(grid());
  rounds_.save(out);
  for (const auto* cells : {&known_, &learning_}) {
    std::vector<Saved> sampled;
    for (std::size_t i = 0; i < cells->size(); ++i) {
      if ((*cells)[i].samples > 0) sampled.push_back({(*cells)[i], i});
    }
    out.put(sampled);
  }
}

void ReflectedRadiance::load(ByteReader& in) {
  if (in.get<std::array<double, 4>>() != grid()) {
    throw std::runtime_error("saved radiance belongs to another scene");
  }
  rounds_.load(in);
  bool good = true;
  for (auto* cells : {&known_, &learning_}) {
    std::fill(cells->begin(), cells->end(), Samples{});
    for (const Saved& s : in.get_vector<Saved>()) {
      good = good && s.cell < cells->size() && std::isfinite(s.samples.sum) &&
             s.samples.samples > 0 && std::isfinite(s.samples.samples);
      if (!good) break;
      (*cells)[s.cell] = s.samples;
    }
  }
  if (!good) throw std::runtime_error("saved radiance is not valid");
  make_means();
}

}  // namespace lacuna
