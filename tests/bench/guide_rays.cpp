// Directions of a guide from one point, and which regions of the empty space their rays come to:
//
//   guide_rays JOB N
//
// JOB's integrator is `inspect` with `"show": "guide_density"`: the point is the surface that it
// evaluates the guide at, the directions those of its guide, as prepared, by the job's seed; with
// guide `bsdf` they are the BSDF's. Prints one object of JSON: the region in front of the point,
// what the guide says of itself, how many directions failed or lead below the surface, and of each
// other ray the region that it enters first after the point's own, before its hit; the region in
// front of the hit; and where that is, in the coordinates of the scene's file. null: there is none.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <string_view>

#include "analysis/skeleton/surface_lookup.h"
#include "base/json/json_text.h"
#include "base/storage/atomic_file.h"
#include "jobs/run/prepare.h"
#include "jobs/spec/job_json.h"
#include "renderer/guides/crossed_faces.h"
#include "renderer/guides/make_guide.h"
#include "renderer/path/guide.h"
#include "tests/jobs/run/silent_observer.h"

namespace {

using namespace lacuna;

const InspectSettings& inspected(const JobSpec& job) {
  const auto* s = std::get_if<InspectSettings>(&job.integrator);
  if (s == nullptr || s->show != InspectQuantity::guide_density) {
    throw std::invalid_argument("the job's integrator must be inspect, and show guide_density");
  }
  return *s;
}

OrderedJson region_json(std::uint32_t region) {
  return region == no_region ? OrderedJson() : OrderedJson(region);
}

/// A guide at one point of a scene.
class GuidedPoint {
 public:
  GuidedPoint(const JobSpec& job, const Prepared& p)
      : p_(p), directions_(make_guiding_distribution(inspected(job).guide)) {
    if (directions_) {
      directions_->prepare(
          {.scene = *p.scene, .pool = *p.pool, .space = *p.space, .camera = *p.camera});
    }
    label_ = &p.space->regions().label;
    transform_ = p.space->voxels().transform;
    lookup_.emplace(transform_, *label_);
    const auto& from = inspected(job).from;
    const Ray ray = p.camera->ray(static_cast<float>(from[0] * job.resolution[0]),
                                  static_cast<float>(from[1] * job.resolution[1]));
    Hit hit;
    if (!p.scene->rays().intersect(ray, hit)) throw std::runtime_error("the point is not there");
    vertex_.kind = Vertex::Kind::surface;
    vertex_.surface = p.scene->surface(ray, hit);
    vertex_.wp = -ray.d;
    p.scene->make_bsdf(vertex_.surface, vertex_.bsdf);
    if (directions_) vertex_.guiding_cell = directions_->cell(vertex_.surface, vertex_.wp);
  }

  std::uint32_t region() const {
    return lookup_->node(V3d(vertex_.surface.x), V3d(vertex_.surface.ng), V3d(vertex_.wp));
  }
  OrderedJson statistics() const {
    OrderedJson all = OrderedJson::object();
    if (!directions_) return all;
    for (const auto& [name, value] : directions_->statistics()) all[name] = value;
    return all;
  }

  /// A direction to the side of the eye; none: it failed, or leads below the surface.
  std::optional<V3f> sample(Rng& rng) const {
    const std::optional<V3f> w = directions_ ? sample_guide(rng) : sample_bsdf(rng);
    const bool above = w && dot(*w, vertex_.side()) > 0;
    return above ? w : std::nullopt;
  }

  OrderedJson ray(const V3f& w) const {
    const Surface& s = vertex_.surface;
    Hit hit;
    const Ray ray{offset_origin(s.x, s.ng, s.offset, w), w};
    const bool hits = p_.scene->rays().intersect(ray, hit);
    const double length = hits ? double(hit.t) / transform_.voxel_size : HUGE_VAL;  // voxels
    OrderedJson told{
        {"entered", region_json(first_entered(w, length))}, {"hit", nullptr}, {"at", nullptr}};
    if (!hits) return told;
    const Surface there = p_.scene->surface(ray, hit);
    const V3d at = V3d(there.x) + p_.scene->data().origin;
    told["hit"] = region_json(lookup_->node(V3d(there.x), V3d(there.ng), -V3d(w)));
    told["at"] = {at.x, at.y, at.z};
    return told;
  }

 private:
  std::optional<V3f> sample_guide(Rng& rng) const {
    if (!(vertex_.guiding_cell.probability > 0)) {
      throw std::runtime_error("the guide has no directions at the point");
    }
    return directions_->sample({vertex_.surface, *vertex_.bsdf, vertex_.wp, vertex_.guiding_cell},
                               rng.next_fine_point(), rng);
  }
  std::optional<V3f> sample_bsdf(Rng& rng) const {
    const auto s = Guide{}.sample(vertex_, rng, Transport::radiance);
    return s ? std::optional(s->wi) : std::nullopt;
  }

  /// The first region other than the point's own on the way to `length`.
  std::uint32_t first_entered(const V3f& w, double length) const {
    VoxelBox all;
    all.add(Imath::V3i(0));
    all.add(label_->size() - Imath::V3i(1));
    const std::uint32_t own = region();
    std::uint32_t entered = no_region;
    const GridRay ray(transform_.to_grid(V3d(vertex_.surface.x)), V3d(w));
    for_each_crossed_face(ray, all, [&](const CrossedFace& face) {
      if (face.t >= length) return false;
      const std::uint32_t label = (*label_)(face.to);
      if (label != own) entered = label;
      return entered == no_region;
    });
    return entered;
  }

  const Prepared& p_;
  std::unique_ptr<GuidingDistribution> directions_;  // null: the BSDF's
  const Grid3<std::uint32_t>* label_ = nullptr;
  GridTransform transform_;
  std::optional<SurfaceLookup> lookup_;
  Vertex vertex_;
};

int number(std::string_view text) {
  int n = -1;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), n);
  if (end.ec != std::errc() || end.ptr != text.data() + text.size() || n < 0) {
    throw std::invalid_argument("N must be a number of 0 or more");
  }
  return n;
}

void print_rays(const JobSpec& job, int n) {
  inspected(job);
  SilentObserver observer;
  const std::function<bool()> never = [] { return false; };
  const Prepared prepared = prepare(
      job, {DataRoot::from_environment(), ScenesRoots::from_environment(), -1, never, observer});
  const GuidedPoint point(job, prepared);
  OrderedJson rays = OrderedJson::array();
  int failed = 0;
  for (int i = 0; i < n; ++i) {
    Rng rng(job.seed, 0, static_cast<std::uint64_t>(i), Rng::Purpose::test);
    if (const auto w = point.sample(rng)) {
      rays.push_back(point.ray(*w));
    } else {
      ++failed;
    }
  }
  fmt::print("{}\n", json_text(OrderedJson{{"region", region_json(point.region())},
                                           {"guide", point.statistics()},
                                           {"failed", failed},
                                           {"rays", std::move(rays)}}));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc != 3) throw std::invalid_argument("usage: guide_rays JOB N");
    print_rays(parse_job(read_file(argv[1], max_job_bytes)), number(argv[2]));
  } catch (const std::exception& e) {
    fmt::print(stderr, "guide_rays: {}\n", e.what());
    return 1;
  }
}
