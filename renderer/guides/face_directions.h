#pragma once

#include "analysis/regions/voxel_face.h"
#include "analysis/skeleton/surface_lookup.h"
#include "renderer/guides/crossed_faces.h"
#include "renderer/guides/region_mixture.h"
#include "renderer/path/guiding_distribution.h"
#include "renderer/settings/guide_settings.h"

namespace lacuna {

/// Directions through voxel faces: samples a face from the distribution of the point's region, then
/// a uniform point on the face. Each face on a ray, occluded or not, could have been sampled, so
/// the density of a direction is the sum over all of them:
///     p(w) = sum_faces P(face) t^2 / |cos|
/// with t the distance in voxels; a face has area 1 (Noel 2015, 10.4, whose pictures came out too
/// bright). `Faces` provides the distributions: PortalFaces or BorderFaceLight. With
/// Faces::leaving_only, faces are sampled and counted only if the ray leaves the region through
/// them.
template <class Faces>
class FaceDirections final : public GuidingDistribution {
 public:
  /// `settings`: of the guide; also constructs Faces.
  template <class Settings>
  explicit FaceDirections(const Settings& settings) : settings_(settings), faces_(settings) {}

  bool needs_space() const override { return true; }
  void prepare(const PrepareContext& context) override {
    transform_ = context.space.voxels().transform;
    label_ = &context.space.regions().label;
    // SurfaceLookup accepts region labels as well as node labels: both mark unlabelled voxels by
    // the same value.
    static_assert(no_region == no_node);
    lookup_.emplace(transform_, *label_);
    lattice_ = RegionLattice(*label_, settings_.mixing);
    faces_.prepare(context, *lookup_);
    regions_ = context.space.regions().regions.size();
  }
  void save(ByteWriter& out) const override { faces_.save(out); }
  void load(ByteReader& in) override { faces_.load(in); }
  std::vector<std::pair<std::string, double>> statistics() const override {
    return faces_.statistics();
  }

  GuidingCell cell(const Surface& s, const V3f& w) const override {
    const std::optional<Imath::V3i> voxel = lookup_->voxel(V3d(s.x), V3d(s.ng), V3d(w));
    if (!voxel) return {};
    const auto index = static_cast<std::uint32_t>(label_->index(*voxel));
    const double mass = mass_of(mixture(transform_.to_grid(V3d(s.x)), index));
    const bool alone = settings_.guide_only && mass > 0;
    return {alone ? 1.0F : static_cast<float>(mass), (*label_)[index], index};
  }

  std::optional<V3f> sample(const GuidedVertex& at, Rng::FinePoint, Rng& rng) const override {
    const V3d from = transform_.to_grid(V3d(at.x()));
    const RegionMixture regions = mixture(from, at.cell.part);
    double left = rng.next_choice() * mass_of(regions);
    std::uint32_t region = no_region;
    for (const auto& share : regions) {
      const double part = share.weight * faces_.mass(share.region);
      if (!(part > 0)) continue;
      region = share.region;
      if (left < part) break;
      left -= part;
    }
    if (region == no_region) return std::nullopt;
    const VoxelFace face = faces_.sample_face(region, from, rng);
    const V2f u = rng.next2();
    const V3d d = face.point(label_->voxel(face.voxel), double(u.x), double(u.y)) - from;
    const double ahead = d.dot(face.normal());
    if (ahead == 0) return std::nullopt;  // a face in the point's own plane is not visible
    if (Faces::leaving_only && ahead < 0) return std::nullopt;
    return V3f(d.normalized());
  }

  Pdf<SolidAngle> pdf(const GuidedVertex& at, const V3f& w) const override {
    const V3d from = transform_.to_grid(V3d(at.x()));
    const RegionMixture regions = mixture(from, at.cell.part);
    const double all = mass_of(regions);
    if (!(all > 0)) return {};
    thread_local FaceParts parts;  // keeps its memory between calls
    parts.clear();
    for (const auto& share : regions) {
      const double mass = faces_.mass(share.region);
      if (mass > 0) faces_.add_parts(share.region, from, share.weight * mass, parts);
    }
    const GridRay ray(from, V3d(w));
    double sum = 0;
    for (const FacePart& part : parts) {
      std::optional<std::uint32_t> last;
      for_each_crossed_face(ray, *part.box, [&](const CrossedFace& face) {
        const std::uint32_t near = last ? *last : label_at(face.from), far = label_at(face.to);
        last = far;
        if (near == far) return true;
        const double p = faces_.probability(part.index, face, near, far, from);
        sum += part.weight * p * face.t * face.t * std::abs(ray.inverse[face.axis]);
        return true;
      });
    }
    return Pdf<SolidAngle>(static_cast<float>(sum / all));
  }

  std::size_t cells() const override { return regions_; }
  /// If only the guide is sampled, no probability is learned.
  AutoNumber probability() const override {
    return settings_.guide_only ? AutoNumber{1} : settings_.probability;
  }
  Counters begin(const IterationContext& context, int edges) override {
    if constexpr (Faces::learns) return faces_.begin(context, edges, transform_);
    return {};
  }
  bool learns() const override {
    if constexpr (Faces::learns) return faces_.learns_from_eye_paths();
    return false;
  }
  std::vector<std::uint32_t> update(const TrainingSamples& samples,
                                    const ThreadPool& pool) override {
    if constexpr (Faces::learns) {
      if (!learns()) return {};
      pool.for_each(static_cast<int>(regions_), [&](int r) {
        const auto region = static_cast<std::uint32_t>(r);
        for (const TrainingSample& s : samples.of(region)) add(region, s);
        faces_.update(region);
      });
    }
    return {};
  }

 private:
  RegionMixture mixture(const V3d& x, std::uint32_t voxel) const {
    return lattice_.mixture(x, (*label_)[voxel]);
  }
  /// Credits the sample to the first face through which its ray leaves the region.
  void add(std::uint32_t region, const TrainingSample& s) {
    if (!(s.pdf > 0) || !(s.radiance > 0)) return;
    const GridRay ray(transform_.to_grid(V3d(s.x)), V3d(s.w));
    for_each_crossed_face(ray, faces_.box(region), [&](const CrossedFace& face) {
      if (label_at(face.from) != region || label_at(face.to) == region) return true;
      const auto index = static_cast<std::uint32_t>(label_->index(face.from));
      faces_.add(region, {index, face.side_of_from()}, double(s.radiance) / double(s.pdf));
      return false;
    });
  }
  /// The fraction of the light that the distributions of these regions cover.
  double mass_of(const RegionMixture& regions) const {
    double sum = 0;
    for (const auto& share : regions) sum += share.weight * faces_.mass(share.region);
    return sum;
  }
  std::uint32_t label_at(const Imath::V3i& v) const {
    return in_grid(v, label_->size()) ? (*label_)(v) : no_region;
  }
  RegionGuideSettings settings_;
  Faces faces_;
  std::size_t regions_ = 0;
  GridTransform transform_;
  const Grid3<std::uint32_t>* label_ = nullptr;
  std::optional<SurfaceLookup> lookup_;
  RegionLattice lattice_;
};

}  // namespace lacuna
