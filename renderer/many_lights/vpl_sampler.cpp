#include "renderer/many_lights/vpl_sampler.h"

#include <algorithm>

namespace lacuna {

VplSampler::VplSampler(const VplContributions& terms, const RandomLightsSettings& settings,
                       std::size_t most_stretches)
    : terms_(terms), settings_(settings) {
  const VplSet& lights = terms.lights();
  const std::size_t longest = (lights.blocks() + most_stretches - 1) / most_stretches;
  before_.push_back(0);
  int edges = 0;
  for (std::size_t b = 0; b < lights.blocks(); ++b) {
    const bool diffuse = lights.diffuse(b) != nullptr;
    bool starts = stretches_.empty();  // a stretch has one kind of lights and one path length
    for (; b >= lights.blocks(edges); ++edges) starts = true;
    if (!starts) {
      const Stretch& s = stretches_.back();
      starts = s.bounded != diffuse || s.end - s.first == longest;
    }
    if (starts) stretches_.push_back({b, b, diffuse, {}});
    if (diffuse) stretches_.back().bounds.add(lights.bounds(b));
    stretches_.back().end = b + 1;
    before_.push_back(before_.back() + static_cast<std::uint64_t>(lights.count(b)));
  }
}

std::vector<VplSampler::Sample> VplSampler::sample(std::span<const ShadingPoint> points,
                                                   const IterationContext& context) {
  PointLanes lanes;
  for (const ShadingPoint& p : points) lanes.add(p);
  std::vector<std::vector<std::size_t>> candidates(points.size());
  for (std::size_t s = 0; s < stretches_.size(); ++s) {
    for_each_bit(may_illuminate(stretches_[s], lanes), [&](int bit) {
      const auto i = static_cast<std::size_t>(bit);
      if (stretches_[s].first < terms_.lights().blocks(points[i].edges)) candidates[i].push_back(s);
    });
  }
  std::vector<Sample> samples;
  std::uint64_t pairs = 0, kept = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    pairs += before_[terms_.lights().blocks(points[i].edges)];
    kept += sample_for(points[i].vertex->surface.x, i, candidates[i],
                       {context.seed, context.iteration, points[i].pixel, Rng::Purpose::gather},
                       samples);
  }
  pairs_ += pairs;
  left_ += kept;
  std::sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) {
    return std::pair(a.block, a.point) < std::pair(b.block, b.point);
  });
  return samples;
}

std::uint64_t VplSampler::may_illuminate(const Stretch& s, const PointLanes& points) const {
  std::uint64_t candidates = points.all();
  if (!s.bounded) return candidates;
  if (settings_.cull) candidates &= points.may_be_lit(s.bounds);
  if (settings_.cutoff > 0) candidates &= points.may_be_near(s.bounds, cutoff());
  return candidates;
}

bool VplSampler::is_near(const V3f& x, std::size_t block, int i) const {
  if (settings_.cutoff == 0) return true;
  const VplGeometry light = terms_.lights().geometry(block, i);
  return light.infinite || (light.x - x).length2() <= cutoff() * cutoff();
}

std::uint64_t VplSampler::sample_for(const V3f& x, std::size_t point,
                                     std::span<const std::size_t> stretches, Rng rng,
                                     std::vector<Sample>& samples) const {
  std::uint64_t total = 0;
  for (const std::size_t s : stretches) total += lights_of(s);
  // Steps are at least 1, so no light is sampled twice.
  const double step = std::max(1.0, double(total) / double(settings_.lights));
  const double u = (double(rng.next_u32()) + 0.5) * 0x1p-32 * step;
  const auto count = std::min(total, static_cast<std::uint64_t>(settings_.lights));
  std::size_t at = 0;
  std::uint64_t passed = 0;                // number of lights of the preceding stretches
  const std::size_t own = samples.size();  // start of this point's entries
  for (std::uint64_t k = 0; k < count; ++k) {
    const auto index =
        std::min(static_cast<std::uint64_t>(u + static_cast<double>(k) * step), total - 1);
    while (index >= passed + lights_of(stretches[at])) passed += lights_of(stretches[at++]);
    const Stretch& s = stretches_[stretches[at]];
    const std::uint64_t light = before_[s.first] + index - passed;
    const auto first = before_.begin() + static_cast<std::ptrdiff_t>(s.first);
    const auto end = before_.begin() + static_cast<std::ptrdiff_t>(s.end);
    const auto after = std::upper_bound(first, end, light);
    const auto block = static_cast<std::size_t>(after - before_.begin()) - 1;
    const auto i = static_cast<int>(light - before_[block]);
    if (!is_near(x, block, i)) continue;
    if (samples.size() == own || samples.back().block != block) {
      samples.push_back({block, point, 0, static_cast<float>(step)});
    }
    samples.back().lights |= std::uint64_t{1} << i;
  }
  return total;
}

double VplSampler::culled() const { return pairs_ == 0 ? 0 : 1 - double(left_) / double(pairs_); }

}  // namespace lacuna
