#include "renderer/path/photon_map.h"

#include <algorithm>
#include <cmath>

#include "base/parallel/for_each_chunked.h"
#include "renderer/core/free_memory.h"

namespace lacuna {

namespace {

/// Bytes of memory per photon, at most: in its part with its hit, in the sorted array, its index
/// there, and in the grid with the memory for sorting.
constexpr double bytes_of_photon = 2.0 * sizeof(Photon) + sizeof(Hit) + sizeof(V3f) + 44;

void require_photons(double photons, double stored) {
  require_free(photons * bytes_of_photon - stored * double{sizeof(Photon)}, [&] {
    return fmt::format(
        "the {:.0f} photons of an iteration need too much memory (fewer light_paths, "
        "or a smaller max_depth, need less)",
        photons);
  });
}

/// Side of a pixel's footprint, scene units, at the median distance of the visible surfaces; at the
/// scene's radius if none is visible.
double footprint(const Scene& scene, const Camera& camera) {
  constexpr int steps = 16;  // of rays across the film
  std::vector<double> sides;
  const auto at = [](int i, int size) {
    return (static_cast<float>(i) + 0.5F) * static_cast<float>(size) / float{steps};
  };
  for (int i = 0; i < steps * steps; ++i) {
    const Ray ray = camera.ray(at(i % steps, camera.width()), at(i / steps, camera.height()));
    Hit hit{};
    if (!scene.rays().intersect(ray, hit)) continue;
    const double distance = (V3d(scene.surface(ray, hit).x) - V3d(ray.o)).length();
    sides.push_back(camera.pixel_side(ray.d, distance));
  }
  if (sides.empty()) return camera.pixel_side(camera.forward(), scene.bounds().radius());
  const auto middle = sides.begin() + static_cast<std::ptrdiff_t>(sides.size() / 2);
  std::nth_element(sides.begin(), middle, sides.end());
  return *middle;
}

double unit_of(RadiusUnit unit, const IterationContext& context) {
  switch (unit) {
    case RadiusUnit::pixels:
      return footprint(context.scene, context.camera);
    case RadiusUnit::scene:
      return context.scene.bounds().radius();
    case RadiusUnit::absolute:
      break;
  }
  return 1;
}

}  // namespace

double merge_radius(const RadiusSettings& settings, const IterationContext& context) {
  const Bounds& box = context.scene.bounds();
  double largest = 0;
  for (int k = 0; k < 3; ++k) {
    if (box.low[k] <= box.high[k]) {
      largest = std::max({largest, std::abs(box.low[k]), std::abs(box.high[k])});
    }
  }
  const double first = settings.radius * unit_of(settings.radius_unit, context);
  const double shrunk =
      first * std::pow(static_cast<double>(context.iteration) + 1, (settings.alpha - 1) / 2);
  const double r = std::max(shrunk, largest * 0x1p-18);
  return r > 0 ? r : 1;  // of a scene without size, where nothing is hit
}

void PhotonSeconds::append_to(std::vector<std::pair<std::string, double>>& statistics) const {
  statistics.emplace_back("light_pass_cpu_seconds", light);
  statistics.emplace_back("photon_grid_cpu_seconds", grid);
  statistics.emplace_back("eye_pass_cpu_seconds", eye);
  statistics.emplace_back("look_up_cpu_seconds", look_up);
}

void PhotonMap::begin(std::int64_t paths) {
  require_photons(static_cast<double>(paths), 0);
  parts_.resize(static_cast<std::size_t>((paths + paths_of_part - 1) / paths_of_part));
  for (Part& part : parts_) {
    part.photons.clear();
    part.hits.clear();
    part.ends.clear();
  }
  stored_ = 0;
  parts_begun_ = 0;
}

void PhotonMap::keep(std::size_t path, const Vertex& v, int index, bool caustic) {
  auto& part = parts_[path / std::size_t{paths_of_part}].photons;
  if (!v.bsdf->connectible() || !v.p_fwd.positive() || is_black(v.throughput)) return;
  if (part.empty()) {
    check_room();
    ++parts_begun_;
  }
  part.push_back(photon(v, index));
  part.back().caustic = caustic;
  constexpr std::size_t some = 64;  // counted together: all threads share the count
  if (part.size() % some == 0) stored_ += some;
}

void PhotonMap::check_room() const {
  const double begun = static_cast<double>(parts_begun_.load());
  const double stored = static_cast<double>(stored_.load());
  if (begun > 0) require_photons(stored / begun * static_cast<double>(parts_.size()), stored);
}

template <class Use>
void PhotonMap::each_photon(const ThreadPool& pool, Use&& use) const {
  std::vector<std::size_t> first(parts_.size() + 1, 0);
  for (std::size_t p = 0; p < parts_.size(); ++p)
    first[p + 1] = first[p] + parts_[p].photons.size();
  pool.for_each(static_cast<int>(parts_.size()), [&](int p) {
    const auto& part = parts_[static_cast<std::size_t>(p)].photons;
    for (std::size_t k = 0; k < part.size(); ++k)
      use(first[static_cast<std::size_t>(p)] + k, part[k]);
  });
}

void PhotonMap::place(double radius, const ThreadPool& pool) {
  radius_ = radius;
  std::size_t n = 0;
  for (const Part& part : parts_) n += part.photons.size();
  positions_.resize(n);
  photons_.resize(n);
  each_photon(pool, [&](std::size_t i, const Photon& p) { positions_.set(i, p.x); });
}

void PhotonMap::arrange(double radius, const ThreadPool& pool) {
  place(radius, pool);
  grid_.build({positions_.begin(), positions_.end()}, radius, pool);
  const std::size_t n = positions_.size();
  places_.resize(n);
  for_each_chunked(pool, n, 1 << 14, [&](std::size_t k) {
    places_.set(grid_.order()[k], static_cast<std::uint32_t>(k));
  });
  each_photon(pool, [&](std::size_t i, const Photon& p) { photons_.set(places_[i], p); });
}

void PhotonMap::arrange_nearest(double radius, const ThreadPool& pool) {
  place(radius, pool);
  tree_.build({positions_.begin(), positions_.end()});
  each_photon(pool, [&](std::size_t i, const Photon& p) { photons_.set(i, p); });
}

}  // namespace lacuna
