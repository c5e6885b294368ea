#include "renderer/guides/lobe_set.h"

#include "renderer/core/direction_around.h"

namespace lacuna {

LobeSet::LobeSet(std::span<const Target> targets) {
  std::vector<double> weights;
  for (const Target& t : targets) {
    points_.push_back(t.at);
    weights.push_back(t.weight);
  }
  choice_ = AliasTable(weights);
  if (choice_.empty()) return;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (i % 8 == 0) blocks_.push_back({});
    Block& b = blocks_.back();
    b.x[i % 8] = points_[i].x;
    b.y[i % 8] = points_[i].y;
    b.z[i % 8] = points_[i].z;
    b.share[i % 8] = choice_.pmf(static_cast<std::uint32_t>(i)).value;
  }
}

std::optional<V3f> LobeSet::sample(const V3f& x, float s, Rng::FinePoint point) const {
  const V3f& to = points_[choice_.sample(point)];
  const V2f u = point.point();
  // cos^(s+1) is uniform. Near the axis 1 - cos is more precise than the cosine.
  const double power = std::log1p(-double(u.x)) / (double(s) + 1);
  const double versine = -std::expm1(power);
  const V3f d = to - x;
  const float length = std::sqrt(dot(d, d));
  if (!(length > 0)) return std::nullopt;
  return direction_around(d / length, versine, u.y);
}

std::array<float, LobeSet::doublings> LobeSet::pdf_of_powers(const V3f& x, const V3f& w) const {
  std::array<Float8, doublings> sums;
  for_each_cosine(x, w, [&](Float8 cosine, Float8 share) {
    for (Float8& sum : sums) {
      sum = sum + share * cosine;
      cosine = cosine * cosine;
    }
  });
  std::array<float, doublings> densities;
  for (std::size_t k = 0; k < doublings; ++k) {
    densities[k] = reduce_add(sums[k]) * static_cast<float>((1U << k) + 1) * norm;
  }
  return densities;
}

}  // namespace lacuna
