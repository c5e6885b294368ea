#include "renderer/many_lights/vpl_sampler.h"

#include <algorithm>

namespace lacuna {

VplSampler::VplSampler(const VplContributions& terms, const RandomLightsSettings& settings,
                       const CubeCulling* cubes, std::size_t most_stretches)
    : terms_(terms), settings_(settings), cubes_(cubes) {
  if (cubes != nullptr) tests_ = cubes->pairs();
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
  for (std::size_t s = 0; s < stretches_.size() && cubes_ == nullptr; ++s) {
    for_each_bit(may_illuminate(stretches_[s], lanes), [&](int bit) {
      const auto i = static_cast<std::size_t>(bit);
      if (stretches_[s].first < terms_.lights().blocks(points[i].edges)) candidates[i].push_back(s);
    });
  }
  std::vector<Sample> samples;
  std::uint64_t pairs = 0, kept = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    pairs += before_[terms_.lights().blocks(points[i].edges)];
    kept += settings_.interleave > 0 ? sample_blocks(points[i], i, candidates[i], context, samples)
            : cubes_ != nullptr      ? sample_in_cube(points[i], i, context, samples)
                                     : sample_for(points[i], i, candidates[i], context, samples);
  }
  if (cubes_ == nullptr) tests_ += stretches_.size() * points.size();
  pairs_ += pairs;
  left_ += kept;
  std::sort(samples.begin(), samples.end());
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

VplSampler::Steps VplSampler::steps(std::uint64_t total, std::uint32_t pixel,
                                    const IterationContext& context) const {
  Rng rng(context.seed, context.iteration, pixel, Rng::Purpose::gather);
  // Steps are at least 1, so no light is sampled twice.
  const double step = std::max(1.0, double(total) / double(settings_.lights));
  return {(double(rng.next_u32()) + 0.5) * 0x1p-32 * step, step,
          std::min(total, static_cast<std::uint64_t>(settings_.lights)), total};
}

std::uint64_t VplSampler::sample_blocks(const ShadingPoint& at, std::size_t point,
                                        std::span<const std::size_t> stretches,
                                        const IterationContext& context,
                                        std::vector<Sample>& samples) const {
  const auto side = static_cast<std::uint32_t>(settings_.interleave);
  const auto width = static_cast<std::uint32_t>(context.camera.width());
  const std::size_t step = std::size_t{side} * side;
  Rng rng(context.seed, context.iteration, 0, Rng::Purpose::gather);
  const std::uint32_t own = at.pixel / width % side * side + at.pixel % width % side;
  const std::size_t first = (own + rng.next_u32() % step) % step;
  const std::size_t blocks = terms_.lights().blocks(at.edges);
  std::uint64_t total = 0;
  for (const std::size_t s : stretches) {
    total += lights_of(s);
    const std::size_t past = stretches_[s].first % step;
    std::size_t b = stretches_[s].first + (first + step - past) % step;
    for (; b < std::min(stretches_[s].end, blocks); b += step) {
      const Sample sample{b, point, 0, static_cast<float>(step)};
      const std::size_t before = samples.size();
      for (int i = 0; i < terms_.lights().count(b); ++i) add(at, sample, i, before, samples);
    }
  }
  return total;
}

void VplSampler::add(const ShadingPoint& at, Sample sample, int i, std::size_t own,
                     std::vector<Sample>& samples) const {
  if (!is_near(at.vertex->surface.x, sample.block, i)) return;
  if (samples.size() == own || samples.back().block != sample.block) samples.push_back(sample);
  samples.back().lights |= std::uint64_t{1} << i;
}

std::uint64_t VplSampler::sample_for(const ShadingPoint& shaded, std::size_t point,
                                     std::span<const std::size_t> stretches,
                                     const IterationContext& context,
                                     std::vector<Sample>& samples) const {
  std::uint64_t total = 0;
  for (const std::size_t s : stretches) total += lights_of(s);
  const Steps sampled = steps(total, shaded.pixel, context);
  std::size_t at = 0;
  std::uint64_t passed = 0;                // number of lights of the preceding stretches
  const std::size_t own = samples.size();  // start of this point's entries
  for (std::uint64_t k = 0; k < sampled.count; ++k) {
    const std::uint64_t index = sampled.number(k);
    while (index >= passed + lights_of(stretches[at])) passed += lights_of(stretches[at++]);
    const Stretch& s = stretches_[stretches[at]];
    const std::uint64_t light = before_[s.first] + index - passed;
    const auto first = before_.begin() + static_cast<std::ptrdiff_t>(s.first);
    const auto end = before_.begin() + static_cast<std::ptrdiff_t>(s.end);
    const auto after = std::upper_bound(first, end, light);
    const auto block = static_cast<std::size_t>(after - before_.begin()) - 1;
    add(shaded, {block, point, 0, sampled.weight()}, static_cast<int>(light - before_[block]), own,
        samples);
  }
  return total;
}

std::uint64_t VplSampler::sample_in_cube(const ShadingPoint& shaded, std::size_t point,
                                         const IterationContext& context,
                                         std::vector<Sample>& samples) const {
  const auto cube = cubes_->left(shaded.vertex->surface.x);
  std::vector<std::span<const std::uint32_t>> groups;
  std::uint64_t total = 0;
  for (std::size_t leaf = 0; leaf < cubes_->leaves(); ++leaf) {
    if (cube && ((*cube)[leaf / 64] >> leaf % 64 & 1) == 0) continue;
    groups.push_back(cubes_->lights_of(leaf));
    total += groups.back().size();
  }
  const Steps sampled = steps(total, shaded.pixel, context);
  const std::size_t allowed = terms_.lights().blocks(shaded.edges);
  std::size_t at = 0;
  std::uint64_t passed = 0;  // number of lights of the preceding groups
  const std::size_t own = samples.size();
  for (std::uint64_t k = 0; k < sampled.count; ++k) {
    const std::uint64_t index = sampled.number(k);
    while (index >= passed + groups[at].size()) passed += groups[at++].size();
    const std::uint64_t light = groups[at][index - passed];
    const auto after = std::upper_bound(before_.begin(), before_.end(), light);
    const auto block = static_cast<std::size_t>(after - before_.begin()) - 1;
    if (block >= allowed) continue;  // too many edges; its probability is that of the others
    add(shaded, {block, point, 0, sampled.weight()}, static_cast<int>(light - before_[block]), own,
        samples);
  }
  return total;
}

double VplSampler::culled() const { return pairs_ == 0 ? 0 : 1 - double(left_) / double(pairs_); }

}  // namespace lacuna
