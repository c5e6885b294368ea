#pragma once

#include "analysis/regions/voxel_face.h"
#include "analysis/skeleton/surface_lookup.h"
#include "renderer/guides/crossed_faces.h"
#include "renderer/guides/guiding_distribution.h"
#include "renderer/guides/region_mixture.h"
#include "renderer/guides/tuning.h"
#include "renderer/settings/guide_settings.h"

namespace lacuna {

/// Directions through voxel faces: samples a face from the distribution of the point's region, then
/// a point uniformly on the face. A direction can be sampled through every face on its way,
/// occluded or not, so its density is the sum over all of them:
///     p(w) = sum_faces P(face) t^2 / |cos|
/// with t the distance in voxels; a face has area 1 (Noel 2015, 10.4, whose pictures came out too
/// bright). `Faces` holds the distributions: PortalFaces or BorderFaceLight. Faces::leaving_only
/// says whether faces are sampled and counted only where the ray leaves the region through them.
template <class Faces>
class FaceDirections final : public GuidingDistribution {
 public:
  /// `settings`: of the guide; Faces is constructed from them too.
  template <class Settings>
  explicit FaceDirections(const Settings& settings) : settings_(settings), faces_(settings) {}

  bool needs_space() const override { return true; }
  void prepare(const PrepareContext& context) override {
    transform_ = context.space.voxels().transform;
    label_ = &context.space.regions().label;
    // SurfaceLookup works on region labels as on node labels: both mark unlabelled voxels alike.
    static_assert(no_region == no_node);
    lookup_.emplace(transform_, *label_);
    lattice_ = RegionLattice(*label_, settings_.mixing);
    faces_.prepare(context, *lookup_);
    // Faces have no strength. Where the guide draws alone there is no probability to learn.
    const AutoNumber probability =
        settings_.guide_only ? AutoNumber{most_guided} : settings_.probability;
    tuning_ = Tuning({1}, probability, context.space.regions().regions.size());
  }
  void save(ByteWriter& out) const override {
    faces_.save(out);
    tuning_.save(out);
  }
  void load(ByteReader& in) override {
    faces_.load(in);
    tuning_.load(in);
  }
  std::vector<std::pair<std::string, double>> statistics() const override {
    auto stats = faces_.statistics();
    for (auto& s : tuning_.statistics()) {
      if (s.first != "mean_strength") stats.push_back(std::move(s));
    }
    return stats;
  }

  GuidingCell cell(const Surface& s, const V3f& w) const override {
    const std::optional<Imath::V3i> voxel = lookup_->voxel(V3d(s.x), V3d(s.ng), V3d(w));
    if (!voxel) return {};
    const auto index = static_cast<std::uint32_t>(label_->index(*voxel));
    const RegionMixture regions = mixture(transform_.to_grid(V3d(s.x)), index);
    const double sum = sum_of(regions, as_used());
    return {settings_.guide_only && sum > 0 ? 1.0F : static_cast<float>(sum), index};
  }

  std::optional<V3f> sample(const GuidedVertex& at, Rng::FinePoint, Rng& rng) const override {
    const V3d from = transform_.to_grid(V3d(at.x()));
    const RegionMixture regions = mixture(from, at.cell.index);
    const auto used = as_used();
    double left = rng.next_choice() * sum_of(regions, used);
    std::uint32_t region = no_region;
    for (const auto& share : regions) {
      const double part = share.weight * used(share.region);
      if (!(part > 0)) continue;
      region = share.region;
      if (left < part) break;
      left -= part;
    }
    if (region == no_region) return std::nullopt;
    const VoxelFace face = faces_.draw(region, from, rng);
    const V2f u = rng.next2();
    const V3d d = face.point(label_->voxel(face.voxel), double(u.x), double(u.y)) - from;
    const double ahead = d.dot(face.normal());
    if (ahead == 0) return std::nullopt;  // a face is not seen from its own plane
    if (Faces::leaving_only && ahead < 0) return std::nullopt;
    return V3f(d.normalized());
  }

  Pdf<SolidAngle> pdf(const GuidedVertex& at, const V3f& w) const override {
    return density(at.cell.index, at.x(), w, as_used());
  }

  bool idle() const override { return tuning_.idle(); }
  std::optional<std::uint64_t> due_pilot() const override { return tuning_.due_pilot(); }
  void begin_pilot() override { tuning_.begin_pilot(); }
  bool learns() const override { return Faces::learns || tuning_.learns(); }
  std::unique_ptr<Accumulator> accumulator() const override {
    return std::make_unique<FaceAccumulator>();
  }
  void accumulate(const GuidingSample& sample, Accumulator& accumulator) const override {
    const std::uint32_t voxel = sample.v.guiding_cell.index;
    if (voxel >= label_->count()) return;
    auto& both = static_cast<FaceAccumulator&>(accumulator);
    const std::uint32_t region = (*label_)[voxel];
    if (tuning_.wants(region)) {
      // The density of the guide alone, including regions whose probability is 0 at present.
      const float p = density(voxel, sample.v.surface.x, sample.wi, [this](std::uint32_t r) {
                        return faces_.mass(r);
                      }).value;
      tuning_.accumulate(sample, region, std::span(&p, 1), both.tuning);
    }
    if constexpr (Faces::learns) {
      // The sample is credited to the first face through which the ray leaves the point's region.
      if (!(sample.radiance > 0)) return;
      const V3d from = transform_.to_grid(V3d(sample.v.surface.x));
      const GridRay ray(from, V3d(sample.wi));
      for_each_crossed_face(ray, faces_.box(region), [&](const CrossedFace& face) {
        if (label_at(face.from) != region || label_at(face.to) == region) return true;
        const auto index = static_cast<std::uint32_t>(label_->index(face.from));
        faces_.accumulate(region, {index, face.side_of_from()}, sample, both.faces);
        return false;
      });
    }
  }
  void record_noise(double variance, double by_bsdf, Accumulator& accumulator) const override {
    static_cast<FaceAccumulator&>(accumulator).tuning.noise.add(variance, by_bsdf);
  }
  void update(std::span<const std::unique_ptr<Accumulator>> accumulators, const ThreadPool& pool,
              double iterations) override {
    std::vector<const typename Faces::Accumulator*> of_faces;
    std::vector<const Tuning::Accumulator*> of_tuning;
    for (const auto& t : accumulators) {
      of_faces.push_back(&static_cast<const FaceAccumulator&>(*t).faces);
      of_tuning.push_back(&static_cast<const FaceAccumulator&>(*t).tuning);
    }
    faces_.update(of_faces, pool);
    if (!tuning_.learns()) return;
    tuning_.update(of_tuning, iterations);
    tuning_.stop_if_useless();
  }

 private:
  RegionMixture mixture(const V3d& x, std::uint32_t voxel) const {
    return lattice_.mixture(x, (*label_)[voxel]);
  }
  struct FaceAccumulator final : Accumulator {
    typename Faces::Accumulator faces;
    Tuning::Accumulator tuning;
    double bytes() const override { return faces.bytes() + tuning.bytes(); }
  };

  /// The probability of sampling from a region's distribution.
  auto as_used() const {
    return [this](std::uint32_t region) {
      return double(tuning_.probability(region)) * faces_.mass(region);
    };
  }
  template <class Drawn>
  static double sum_of(const RegionMixture& regions, const Drawn& drawn) {
    double sum = 0;
    for (const auto& share : regions) sum += share.weight * drawn(share.region);
    return sum;
  }
  /// Density of `w` at `x`, where region r is sampled with probability `drawn(r)`.
  template <class Drawn>
  Pdf<SolidAngle> density(std::uint32_t voxel, const V3f& x, const V3f& w,
                          const Drawn& drawn) const {
    const V3d from = transform_.to_grid(V3d(x));
    const RegionMixture regions = mixture(from, voxel);
    const double all = sum_of(regions, drawn);
    if (!(all > 0)) return {};
    thread_local FaceParts parts;  // keeps its memory
    parts.clear();
    for (const auto& share : regions) {
      const double often = drawn(share.region);
      if (often > 0) faces_.add_parts(share.region, from, share.weight * often, parts);
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
  std::uint32_t label_at(const Imath::V3i& v) const {
    return in_grid(v, label_->size()) ? (*label_)(v) : no_region;
  }
  RegionGuideSettings settings_;
  Faces faces_;
  Tuning tuning_;
  GridTransform transform_;
  const Grid3<std::uint32_t>* label_ = nullptr;
  std::optional<SurfaceLookup> lookup_;
  RegionLattice lattice_;
};

}  // namespace lacuna
