#include "renderer/many_lights/cache_points.h"

#include "renderer/core/free_memory.h"
#include "renderer/many_lights/shading_points.h"
#include "renderer/many_lights/split_points.h"
#include "renderer/path/shadow_queue.h"

namespace lacuna {

namespace {

constexpr int part = EyeBatch::size;  // pixels

/// Lower bound of a rank, relative to the farthest neighbour: the nearest cache point gets at most
/// a thousand times the weight of the farthest, even if it coincides with the shading point (rank
/// 0).
constexpr float least_rank = 1e-3F;

/// The bits of a byte as eight floats.
struct ByteTable {
  alignas(32) std::array<std::array<float, 8>, 256> of;
  ByteTable() {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      for (std::size_t bit = 0; bit < 8; ++bit)
        of[byte][bit] = (byte >> bit & 1) != 0 ? 1.0F : 0.0F;
    }
  }
};
const ByteTable bytes;

/// If lights are sampled: the largest number of cache point tests, relative to those of gathered
/// lights.
constexpr double largest_share = 0.25;

}  // namespace

std::size_t CachePoints::affordable(const LightPass& pass, std::size_t shading_points) const {
  const std::size_t lights = pass.terms.lights().size();
  if (pass.gathered() == lights) return wanted_;
  const double most =
      largest_share * double(shading_points) * double(pass.gathered()) / double(lights);
  return std::clamp<std::size_t>(static_cast<std::size_t>(most), 1, wanted_);
}

std::vector<std::uint32_t> CachePoints::choose(const LightPass& pass, Counters& counters) {
  const IterationContext& context = pass.context;
  const int pixels = context.camera.width() * context.camera.height();
  std::vector<SurfacePoint> of_pixel(static_cast<std::size_t>(pixels));
  std::vector<std::uint8_t> found(of_pixel.size(), 0);
  counters += for_each_part(context, (pixels + part - 1) / part, [&](int i, Counters& count) {
    ShadingPoints points(context, pass.max_depth, pass.least_alpha, count);
    std::vector<std::uint32_t> queried;
    for (int p = i * part; p < std::min(pixels, (i + 1) * part); ++p) {
      queried.push_back(static_cast<std::uint32_t>(p));
    }
    points.find(queried, [&](const Vertex& v, int, std::uint32_t pixel) {
      of_pixel[pixel] = surface_point(v);
      found[pixel] = 1;
    });
  });
  std::vector<SurfacePoint> there;
  std::vector<std::uint32_t> at;
  for (std::size_t p = 0; p < of_pixel.size(); ++p) {
    if (found[p] == 0) continue;
    there.push_back(of_pixel[p]);
    at.push_back(static_cast<std::uint32_t>(p));
  }
  const auto groups = split_points(there, affordable(pass, there.size()),
                                   static_cast<float>(context.scene.bounds().radius()));
  std::vector<std::uint32_t> chosen;
  weights_.clear();
  Rng rng(context.seed, context.iteration, 0, Rng::Purpose::cache_points);
  for (const auto& group : groups) {
    chosen.push_back(at[group[rng.below(group.size())]]);
    weights_.push_back(static_cast<double>(group.size()) / static_cast<double>(there.size()));
  }
  return chosen;
}

Counters CachePoints::build(const LightPass& pass) {
  Counters counters;
  const bool of_use = pass.equal || keep_ == Keep::visibilities;
  const std::vector<std::uint32_t> pixels =
      of_use ? choose(pass, counters) : std::vector<std::uint32_t>{};
  points_.assign(pixels.size(), {V3f(0, 0, 0), V3f(0, 0, 0)});
  variances_.assign(pixels.size(), 0.0);
  scales_.assign(pixels.size(), 0.0);
  blocks_ = pass.terms.lights().blocks();
  if (keep_ == Keep::visibilities) {
    require_free(double(pixels.size()) * double(blocks_) * sizeof(VisibilityBits), [&] {
      return fmt::format(
          "many_lights: the visibility of {} lights at {} cache points; lower "
          "cache_points or light_paths",
          pass.terms.lights().size(), pixels.size());
    });
    visibility_.assign(pixels.size() * blocks_, {});
  }
  constexpr std::size_t together = 4;
  const int parts = static_cast<int>((pixels.size() + together - 1) / together);
  counters += for_each_part(pass.context, parts, [&](int i, Counters& count) {
    ShadingPoints points(pass.context, pass.max_depth, pass.least_alpha, count);
    const std::size_t first = static_cast<std::size_t>(i) * together;
    for (std::size_t k = first; k < std::min(pixels.size(), first + together); ++k) {
      points.find(std::span(pixels).subspan(k, 1),
                  [&](const Vertex& v, int depth, std::uint32_t pixel) {
                    points_[k] = surface_point(v);
                    fill(pass, k, {v, depth, pass.max_depth, pixel}, count);
                  });
    }
  });
  tree_.build(points_);
  picture_variance_ = 0;
  for (std::size_t i = 0; i < variances_.size(); ++i) {
    picture_variance_ += weights_[i] * variances_[i] * scales_[i] * scales_[i];
  }
  return counters;
}

void CachePoints::fill(const LightPass& pass, std::size_t point, const ShadingPoint& at,
                       Counters& counters) {
  struct Contribution {
    std::size_t block;
    int light;
    float value;
  };
  const VplSet& lights = pass.terms.lights();
  ShadowQueue<Contribution> queue;
  Terms terms;
  PointLanes here;
  here.add(at);
  double sum = 0;
  double sum2 = 0;
  const auto flush = [&] {
    queue.flush(pass.context.scene.rays(), counters, [&](const Contribution& s) {
      const double t = double(s.value) / double(at.scale);
      sum += t;
      sum2 += t * t;
      if (keep_ == Keep::visibilities) {
        visibility_[point * blocks_ + s.block].visible |= std::uint64_t{1} << s.light;
      }
    });
  };
  for (std::size_t b = 0; b < lights.blocks(); ++b) {
    std::uint64_t lit = 0;
    if (pass.terms.may_light(b, here) != 0) {
      pass.terms.evaluate(at, b, terms);
      lit = terms.lit;
      for_each_bit(lit, [&](int i) {
        queue.add(pass.terms.ray(at, b, i), {b, i, terms.luminance[i]});
      });
    }
    const std::uint64_t dark = all_ ? lights.mask(b) & ~lit : 0;
    for_each_bit(dark, [&](int i) { queue.add(pass.terms.ray_from_side(at, b, i), {b, i, 0}); });
    if (keep_ == Keep::visibilities) visibility_[point * blocks_ + b].tested = lit | dark;
    if (b % 16 == 15) flush();
    if (b % 1024 == 1023 && pass.context.stop()) throw IterationStopped{};
  }
  flush();
  const auto n = static_cast<double>(std::max<std::size_t>(1, lights.size()));
  const double mean = sum / n;
  const bool known = pass.equal && at.scale > 0;
  variances_[point] = known ? std::max(0.0, sum2 / n - mean * mean) : 0.0;
  scales_[point] = double(at.scale);
}

CachePoints::Neighbours CachePoints::nearest(const ShadingPoint& at) const {
  Neighbours neighbours;
  const SurfacePoint point = surface_point(*at.vertex);
  neighbours.n = static_cast<int>(tree_.nearest(
      point, std::span(neighbours.index).first(static_cast<std::size_t>(neighbours_))));
  // Weights are inversely proportional to RecordTree::rank() (Clarberg and Akenine-Moeller
  // 2008).
  std::array<float, max_neighbours> rank{};
  float farthest = 0;
  const auto n = static_cast<std::size_t>(neighbours.n);
  for (std::size_t j = 0; j < n; ++j) {
    rank[j] = RecordTree::rank(point, points_[neighbours.index[j]]);
    farthest = std::max(farthest, rank[j]);
  }
  float total = 0;
  for (std::size_t j = 0; j < n; ++j) {
    neighbours.weight[j] =
        farthest > 0 ? farthest / std::max(rank[j], least_rank * farthest) : 1.0F;
    total += neighbours.weight[j];
  }
  for (std::size_t j = 0; j < n; ++j) neighbours.weight[j] /= total;
  return neighbours;
}

float CachePoints::deviation(VarianceOf of, const ShadingPoint& at,
                             const Neighbours& neighbours) const {
  if (of == VarianceOf::picture) return static_cast<float>(std::sqrt(picture_variance_));
  double variance = 0;
  for (std::size_t j = 0; j < static_cast<std::size_t>(neighbours.n); ++j) {
    const std::uint32_t i = neighbours.index[j];
    const double scale = of == VarianceOf::cache_points ? scales_[i] : 1;
    variance += double(neighbours.weight[j]) * variances_[i] * scale * scale;
  }
  return static_cast<float>(std::sqrt(variance) *
                            (of == VarianceOf::cache_points ? 1 : double(at.scale)));
}

std::uint64_t CachePoints::expected(const Neighbours& neighbours, std::size_t block,
                                    Lanes& q) const {
  std::uint64_t any_tested = 0;
  for (std::size_t j = 0; j < static_cast<std::size_t>(neighbours.n); ++j) {
    any_tested |= visibility_[neighbours.index[j] * blocks_ + block].tested;
  }
  for (int k = 0; k < Lanes::groups; ++k) {
    Float8 visible, tested;
    for (std::size_t j = 0; j < static_cast<std::size_t>(neighbours.n); ++j) {
      const VisibilityBits& stored = visibility_[neighbours.index[j] * blocks_ + block];
      const Float8 weight = neighbours.weight[j];
      visible = visible + weight * Float8::load(bytes.of[stored.visible >> (8 * k) & 0xff].data());
      tested = tested + weight * Float8::load(bytes.of[stored.tested >> (8 * k) & 0xff].data());
    }
    q.set(k, keep_where(tested > 0, visible / tested));
  }
  return any_tested;
}

}  // namespace lacuna
