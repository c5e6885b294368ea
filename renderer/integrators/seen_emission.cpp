#include "renderer/integrators/seen_emission.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "renderer/path/tiles.h"

namespace lacuna {
namespace {

/// A pixel sees one value if the luminances differ by less than this fraction of the largest.
constexpr float alike = 0.01F;

constexpr std::size_t most_rays = 16;  // SeenEmission::rays()

Rgb emission_at(const Scene& scene, const Ray& ray, bool is_hit, const Hit& hit) {
  if (!is_hit) return scene.emitters().background(ray.d);
  const SceneData& data = scene.data();
  if (!data.materials[data.meshes[hit.mesh].material].emits()) return Rgb(0, 0, 0);
  return scene.emitted(scene.surface(ray, hit), -ray.d);
}

Rgb emission_along(const Scene& scene, const Ray& ray) {
  Hit hit;
  const bool is_hit = scene.rays().intersect(ray, hit);
  return emission_at(scene, ray, is_hit, hit);
}

/// Calls `at(u)` for a point in each cell of a grid of `side` x `side` over [0, 1)^2.
template <class At>
void stratified(int side, Rng& rng, At&& at) {
  const auto n = static_cast<float>(side);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const V2f cell(static_cast<float>(x), static_cast<float>(y));
      at((cell + rng.next2()) / n);
    }
  }
}

/// The range of the luminances that are added.
struct Range {
  float low = std::numeric_limits<float>::infinity(), high = 0;

  void add(const Range& r) {
    low = std::min(low, r.low);
    high = std::max(high, r.high);
  }
};

/// For each pixel, the range of the emitted luminances along four camera rays.
std::vector<Range> seen_ranges(const PrepareContext& context) {
  const Camera& camera = context.camera;
  const auto width = static_cast<std::size_t>(camera.width());
  std::vector<Range> seen(width * static_cast<std::size_t>(camera.height()));
  context.pool.for_each(camera.height(), [&](int y) {
    context.pool.check_stop();
    const std::size_t first = static_cast<std::size_t>(y) * width;
    std::vector<Ray> rays;
    for (int x = 0; x < camera.width(); ++x) {
      Rng rng(0, 0, first + static_cast<std::size_t>(x), Rng::Purpose::emission_ranges);
      stratified(2, rng, [&](const V2f& u) { rays.push_back(camera.sample({x, y}, u, rng)); });
    }
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint8_t> is_hit(rays.size());
    context.scene.rays().intersect(rays, hits, is_hit);
    for (std::size_t k = 0; k < rays.size(); ++k) {
      const float l = luminance(emission_at(context.scene, rays[k], is_hit[k] != 0, hits[k]));
      seen[first + k / 4].add({l, l});
    }
  });
  return seen;
}

/// The range of the luminances in the 3 x 3 pixels around `pixel`, in a film of `size`; 0 if they
/// are one value.
float difference_around(const std::vector<Range>& seen, const V2i& size, const V2i& pixel) {
  Range around;
  for (int y = std::max(pixel.y - 1, 0); y <= std::min(pixel.y + 1, size.y - 1); ++y) {
    for (int x = std::max(pixel.x - 1, 0); x <= std::min(pixel.x + 1, size.x - 1); ++x) {
      around.add(seen[std::size_t(y) * std::size_t(size.x) + std::size_t(x)]);
    }
  }
  const float range = around.high - around.low;
  return range > alike * around.high ? range : 0.0F;
}

/// The position of a triangle in the film.
struct SeenTriangle {
  std::array<V3f, 4> points;             ///< the corners and the centre
  V2f low{HUGE_VALF}, high{-HUGE_VALF};  ///< the box around it in the film, pixels
};
/// None if a corner is not in the film.
std::optional<SeenTriangle> seen_triangle(const Camera& camera, const Mesh& mesh,
                                          const std::array<std::uint32_t, 3>& corners) {
  SeenTriangle t;
  for (std::size_t k = 0; k < 3; ++k) {
    const V3f& corner = mesh.positions[corners[k]];
    const V3f eye = camera.eye(corner);
    const V3f edge = corner - eye;
    if (!(edge.length2() > 0)) return std::nullopt;
    const std::optional<V2f> p = camera.project(eye, edge.normalized());
    if (!p) return std::nullopt;
    t.points[k] = corner;
    t.low = V2f(std::min(t.low.x, p->x), std::min(t.low.y, p->y));
    t.high = V2f(std::max(t.high.x, p->x), std::max(t.high.y, p->y));
  }
  t.points[3] = (t.points[0] + t.points[1] + t.points[2]) / 3.0F;
  return t;
}

/// Calls `at(pixel, luminance)` for the pixels around each visible emitting triangle that is at
/// most two pixels large: the rays of seen_ranges() may miss it.
template <class At>
void for_each_small_emitter(const PrepareContext& context, At&& at) {
  constexpr float small = 2;  // pixels
  const Camera& camera = context.camera;
  const SceneData& data = context.scene.data();
  for (const Mesh& mesh : data.meshes) {
    const Material& material = data.materials[mesh.material];
    if (!material.emits()) continue;
    context.pool.check_stop();
    const float l = luminance(material.emission);
    for (const auto& corners : mesh.triangles) {
      const std::optional<SeenTriangle> t = seen_triangle(camera, mesh, corners);
      if (!t || t->high.x - t->low.x > small || t->high.y - t->low.y > small) continue;
      const bool hidden = std::ranges::all_of(t->points, [&](const V3f& p) {
        const V3f eye = camera.eye(p);
        return context.scene.rays().occluded({eye, (p - eye) * 0.999F, 1.0F});
      });
      if (hidden) continue;
      const V2i last(std::min(camera.width() - 1, int(t->high.x)),
                     std::min(camera.height() - 1, int(t->high.y)));
      for (int y = std::max(0, int(t->low.y)); y <= last.y; ++y) {
        for (int x = std::max(0, int(t->low.x)); x <= last.x; ++x) at(V2i(x, y), l);
      }
    }
  }
}

}  // namespace

void SeenEmission::prepare(const PrepareContext& context) {
  known_.clear();
  worth_any_ = false;
  if (context.scene.emitters().empty()) return;
  const V2i size(context.camera.width(), context.camera.height());
  const std::vector<Range> seen = seen_ranges(context);
  std::vector<float> apart(seen.size());
  const auto index = [&](const V2i& pixel) {
    return std::size_t(pixel.y) * std::size_t(size.x) + std::size_t(pixel.x);
  };
  context.pool.for_each(size.y, [&](int y) {
    for (int x = 0; x < size.x; ++x) {
      apart[index({x, y})] = difference_around(seen, size, {x, y});
    }
  });
  for_each_small_emitter(context, [&](const V2i& pixel, float l) {
    float& range = apart[index(pixel)];
    range = std::max(range, l);
  });
  share_rays(apart);
}

void SeenEmission::share_rays(const std::vector<float>& apart) {
  known_.assign(apart.size(), even);
  double largest = 0;
  for (const float a : apart) largest = std::max(largest, double(a));
  if (!(largest > 0)) return;
  const std::size_t budget = apart.size() / 2;
  // Rays in proportion to the range, at most most_rays: halves the factor until all fit the budget.
  for (double per_range = 0x1p20;; per_range /= 2) {
    std::size_t sum = 0;
    for (std::size_t i = 0; i < apart.size(); ++i) {
      if (!(apart[i] > 0)) continue;
      const double n = std::clamp(double(apart[i]) / largest * per_range, 1.0, double(most_rays));
      known_[i] = static_cast<Known>(std::bit_floor(static_cast<std::size_t>(n)));
      if (known_[i] > one) sum += known_[i];
    }
    worth_any_ = sum > 0;
    if (sum <= budget) return;
  }
}

Rgb SeenEmission::mean(const IterationContext& context, std::size_t pixel, int n,
                       Counters& counters) {
  const int width = context.camera.width();
  const V2i at(static_cast<int>(pixel) % width, static_cast<int>(pixel) / width);
  std::array<Ray, most_rays> rays;
  std::array<Hit, most_rays> hits;
  std::array<std::uint8_t, most_rays> is_hit{};
  const auto count = static_cast<std::size_t>(n);
  for (std::size_t k = 0; k < count; ++k) {
    Rng rng = context.path_numbers(pixel, k, count, Rng::Purpose::emission_means);
    rays[k] = context.camera.sample(at, rng.next2(), rng);
  }
  context.scene.rays().intersect(std::span(rays).first(count), hits, is_hit);
  counters.rays += count;
  Rgb sum(0, 0, 0);
  for (std::size_t k = 0; k < count; ++k) {
    sum += emission_at(context.scene, rays[k], is_hit[k] != 0, hits[k]);
  }
  return sum / static_cast<float>(n);
}

Counters SeenEmission::add(const IterationContext& context, double samples, Image& image) const {
  if (known_.empty()) return {};
  const int side = static_cast<int>(std::ceil(std::sqrt(samples)));
  return for_each_tile(context, image, [&](const Tile& tile, Counters& counters) {
    for (int i = 0; i < tile.pixels(); ++i) {
      const V2i pixel = tile.pixel(i);
      const std::size_t index = image.index(pixel.x, pixel.y);
      Rng rng(context.seed, context.iteration, index);
      Rgb sum(0, 0, 0);
      float n = 0;
      const bool uneven = known_[index] != even;
      stratified(uneven ? side : 1, rng, [&](const V2f& u) {
        sum += emission_along(context.scene, context.camera.sample(pixel, u, rng));
        ++n;
      });
      counters.samples += static_cast<std::uint64_t>(n);
      counters.rays += static_cast<std::uint64_t>(n);
      accumulate(image.pixels[index], sum / n, counters);
      context.light.add_seen(index, sum / n);
    }
  });
}

std::size_t SeenEmission::uneven_pixels() const {
  return known_.size() - static_cast<std::size_t>(std::count(known_.begin(), known_.end(), even));
}

}  // namespace lacuna
