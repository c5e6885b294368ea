#include "renderer/guides/reflected_radiance.h"

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

ReflectedRadiance::Cell ReflectedRadiance::cell(const Vertex& v) const {
  Cell c{};
  const V3d p = (V3d(v.surface.x) - low_) * scale_;
  for (unsigned axis = 0; axis < 3; ++axis) {
    c.at[axis] = static_cast<std::uint32_t>(std::clamp(p[int(axis)], 0.0, side - 1.0));
  }
  const V3f n = v.side();
  int longest = std::abs(n.y) > std::abs(n.x) ? 1 : 0;
  if (std::abs(n.z) > std::abs(n[longest])) longest = 2;
  c.normal = static_cast<std::uint32_t>(2 * longest + (n[longest] < 0 ? 1 : 0));
  return c;
}

std::size_t ReflectedRadiance::index(const Cell& c, std::size_t level) {
  const std::size_t n = std::size_t{side} >> level;
  std::size_t i = c.normal;
  for (const std::uint32_t x : c.at) i = i * n + (x >> level);
  return i;
}

float ReflectedRadiance::at(const Vertex& v) const {
  if (samples_ == 0) return -1;
  const Cell c = cell(v);
  for (std::size_t level = 0; level < levels; ++level) {
    const float mean = means_[level][index(c, level)];
    if (mean >= 0) return mean;
  }
  return mean_;
}

void ReflectedRadiance::record(const Vertex& v, double value, Accumulator& accumulator) const {
  if (std::isfinite(value)) {
    accumulator.add(static_cast<std::uint32_t>(index(cell(v), 0)), value);
  }
}

void ReflectedRadiance::update(std::span<const Accumulator* const> accumulators) {
  for (const Accumulator* a : accumulators) {
    for (const auto& [i, met] : a->cells_) {
      learning_[i].sum += met.sum;
      learning_[i].samples += met.samples;
    }
  }
  if (++iteration_ < std::uint64_t{1} << round_) return;
  iteration_ = 0;
  ++round_;
  std::swap(known_, learning_);
  std::fill(learning_.begin(), learning_.end(), Samples{});
  make_means();
}

void ReflectedRadiance::make_means() {
  std::vector<Samples> sums = known_;
  samples_ = 0;
  double sum = 0;
  for (const Samples& s : known_) {
    sum += s.sum;
    samples_ += s.samples;
  }
  mean_ = static_cast<float>(sum / samples_);
  for (std::size_t level = 0; level < levels; ++level) {
    const std::size_t n = std::size_t{side} >> level;
    means_[level].resize(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const Samples& s = sums[i];
      means_[level][i] = s.samples >= least_samples ? static_cast<float>(s.sum / s.samples) : -1;
    }
    if (n == 1) break;
    std::vector<Samples> above(sums.size() / 8);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const std::size_t z = i % n, y = i / n % n, x = i / (n * n) % n, normal = i / (n * n * n);
      auto& to = above[((normal * (n / 2) + x / 2) * (n / 2) + y / 2) * (n / 2) + z / 2];
      to.sum += sums[i].sum;
      to.samples += sums[i].samples;
    }
    sums = std::move(above);
  }
}

void ReflectedRadiance::save(ByteWriter& out) const {
  out.put(grid());
  out.put(round_);
  out.put(iteration_);
  for (const auto* cells : {&known_, &learning_}) {
    std::vector<Saved> met;
    for (std::size_t i = 0; i < cells->size(); ++i) {
      if ((*cells)[i].samples > 0) met.push_back({(*cells)[i], i});
    }
    out.put(met);
  }
}

void ReflectedRadiance::load(ByteReader& in) {
  if (in.get<std::array<double, 4>>() != grid()) {
    throw std::runtime_error("saved radiance belongs to another scene");
  }
  round_ = in.get<std::uint64_t>();
  iteration_ = in.get<std::uint64_t>();
  bool good = round_ < 63 && iteration_ < std::uint64_t{1} << round_;
  for (auto* cells : {&known_, &learning_}) {
    for (const Saved& s : in.get_vector<Saved>()) {
      good = good && s.cell < cells->size() && std::isfinite(s.met.sum) && s.met.samples > 0 &&
             std::isfinite(s.met.samples);
      if (!good) break;
      (*cells)[s.cell] = s.met;
    }
  }
  if (!good) throw std::runtime_error("saved radiance is not valid");
  make_means();
}

}  // namespace lacuna
