#include "renderer/guides/reflected_radiance.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lacuna {

ReflectedRadiance::ReflectedRadiance(const V3d& low, const V3d& size, std::uint32_t classes,
                                     double enough_samples)
    : low_(low), enough_(enough_samples) {
  const double longest = std::max({size.x, size.y, size.z});
  scale_ = longest > 0 ? side / longest : 0;
  known_.assign(std::size_t{classes} * sides * side * side * side, {});
  learning_ = known_;
  make_moments();
}

ReflectedRadiance::Cell ReflectedRadiance::cell(const Vertex& v, std::uint32_t of_class) const {
  Cell c{};
  const V3d p = (V3d(v.surface.x) - low_) * scale_;
  for (unsigned axis = 0; axis < 3; ++axis) {
    c.at[axis] = static_cast<std::uint32_t>(std::clamp(p[int(axis)], 0.0, side - 1.0));
  }
  const V3f n = v.side();
  int longest = std::abs(n.y) > std::abs(n.x) ? 1 : 0;
  if (std::abs(n.z) > std::abs(n[longest])) longest = 2;
  c.side = of_class * sides + static_cast<std::uint32_t>(2 * longest + (n[longest] < 0 ? 1 : 0));
  return c;
}

std::size_t ReflectedRadiance::index(const Cell& c) {
  std::size_t i = c.side;
  for (const std::uint32_t x : c.at) i = i * side + x;
  return i;
}

void ReflectedRadiance::update(std::span<const Accumulator* const> accumulators,
                               double iterations) {
  for (const Accumulator* a : accumulators) {
    for (const auto& [i, met] : a->cells_) learning_[i] += met;
  }
  end(iterations);
}

void ReflectedRadiance::end(double iterations) {
  if (!rounds_.add(iterations)) return;
  rounds_.next();
  std::swap(known_, learning_);
  std::fill(learning_.begin(), learning_.end(), Samples{});
  make_moments();
}

ReflectedRadiance::Moments ReflectedRadiance::moments(const Samples& s) {
  return {static_cast<float>(s.sum / s.samples), static_cast<float>(s.squares / s.samples),
          static_cast<float>(s.rays / s.samples)};
}

std::size_t ReflectedRadiance::above(std::size_t i, std::size_t n) {
  const std::size_t z = i % n, y = i / n % n, x = i / (n * n) % n, face = i / (n * n * n);
  return ((face * (n / 2) + x / 2) * (n / 2) + y / 2) * (n / 2) + z / 2;
}

void ReflectedRadiance::make_moments() {
  std::array<std::vector<Samples>, levels> sums;
  sums[0] = known_;
  for (std::size_t level = 1; level < levels; ++level) {
    const std::vector<Samples>& below = sums[level - 1];
    sums[level].resize(below.size() / 8);
    const std::size_t n = std::size_t{side} >> (level - 1);
    for (std::size_t i = 0; i < below.size(); ++i) sums[level][above(i, n)] += below[i];
  }
  Samples all;
  for (const Samples& s : sums[levels - 1]) all += s;
  samples_ = all.samples;
  moments_.assign(1, moments(all));
  for (std::size_t level = levels; level-- > 0;) {
    const std::vector<Samples>& here = sums[level];
    const std::size_t n = std::size_t{side} >> level;
    std::vector<Moments> found(here.size());
    for (std::size_t i = 0; i < here.size(); ++i) {
      found[i] =
          here[i].samples >= least_samples ? moments(here[i]) : moments_[n > 1 ? above(i, n) : 0];
    }
    moments_ = std::move(found);
  }
}

void ReflectedRadiance::save(ByteWriter& out) const {
  out.put(grid());
  rounds_.save(out);
  for (const auto* cells : {&known_, &learning_}) {
    std::vector<Saved> met;
    for (std::size_t i = 0; i < cells->size(); ++i) {
      if ((*cells)[i].samples > 0) met.push_back({(*cells)[i], i});
    }
    out.put(met);
  }
}

void ReflectedRadiance::load(ByteReader& in) {
  if (in.get<std::array<double, 5>>() != grid()) {
    throw std::runtime_error("saved radiance belongs to another scene");
  }
  rounds_.load(in);
  bool good = true;
  for (auto* cells : {&known_, &learning_}) {
    for (const Saved& s : in.get_vector<Saved>()) {
      good = good && s.cell < cells->size() && std::isfinite(s.met.sum) && s.met.samples > 0 &&
             std::isfinite(s.met.samples) && s.met.squares >= 0 && std::isfinite(s.met.squares) &&
             s.met.rays >= 0 && std::isfinite(s.met.rays);
      if (!good) break;
      (*cells)[s.cell] = s.met;
    }
  }
  if (!good) throw std::runtime_error("saved radiance is not valid");
  make_moments();
}

}  // namespace lacuna
