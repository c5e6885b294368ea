#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/core/alias_table.h"
#include "renderer/core/bounds.h"
#include "renderer/emitters/emitter_point.h"
#include "renderer/emitters/environment.h"
#include "renderer/emitters/light_le_sample.h"
#include "renderer/emitters/pointwise_selection.h"
#include "renderer/geometry/alpha_mask.h"
#include "renderer/geometry/scene_data.h"
#include "renderer/geometry/surface.h"
#include "renderer/images/texture_means.h"

namespace lacuna {

/// All emitters of a scene. An emitter is selected by its power, with probability 1/8 by source
/// first; then the density of a point on an emitter does not depend on the receiver. With a light
/// tree, an emitter can instead be selected for a given receiver.
class EmitterSet {
 public:
  /// `bounds`: the bounding box of all triangles. The power of an infinite emitter is its power
  /// through the great disk of the box's sphere; its light paths start on the sides of the box.
  /// Keeps a pointer to `scene`; the textures of emission and of masks must be decoded.
  /// `pointwise`: build the selection for a receiver.
  EmitterSet(const SceneData& scene, std::unique_ptr<Environment> environment, const Bounds& bounds,
             bool pointwise);

  bool empty() const { return selection_.empty(); }
  std::size_t size() const { return entries_.size(); }

  /// An emitter, and the random numbers that place a point on it.
  struct Selected {
    std::uint32_t entry = 0;
    Rng::FinePoint at{};
  };
  /// Selects an emitter by power and prefetches its memory; called before the ray to the receiver
  /// is traced. Requires !empty().
  Selected choose(Rng& rng) const { return choose(rng.next_fine_point()); }
  /// For n equidistant values of `at.x`, selects n different emitters if all n have equal power.
  Selected choose(Rng::FinePoint at) const {
    const std::uint32_t i = selection_.sample(at);
    prefetch(i);
    return {i, at};
  }
  /// Prefetches what sample() reads of the emitter `chosen`.
  void prefetch(std::uint32_t chosen) const { __builtin_prefetch(&entries_[chosen]); }
  /// The selection for a receiver; null unless built.
  const PointwiseSelection* pointwise() const { return pointwise_ ? &*pointwise_ : nullptr; }
  /// Samples a point on the selected emitter; its density includes the selection. Inline: next
  /// event estimation calls it at every vertex, nearly always for a triangle.
  EmitterPoint sample(const Selected& selected) const {
    const Entry& e = entries_[selected.entry];
    const Source& source = sources_[e.source];
    if (source.kind != Source::Kind::mesh) [[unlikely]]
      return sample_light(selected);
    const V2f b = sample_triangle(selected.at.point());
    EmitterPoint p;
    p.entry = selected.entry;
    p.both_sides = source.both_sides;
    p.x = e.at(b.x, b.y);
    p.ng = e.ng;
    p.offset = ray_offset(p.x, p.ng, e.plane_error);
    p.pdf = e.pdf;
    p.emission = source.emission;
    if (source.textured || source.colored || source.mask != none) [[unlikely]]
      p.emission = varying_emission(source, selected, b);
    return p;
  }
  /// Samples the first edge of a light path from the point `e`.
  std::optional<LightLeSample> sample_Le(const EmitterPoint& e, Rng& rng) const {
    return lacuna::sample_Le(e, bounds_, rng);
  }

  /// Density with which sample() returns a point of triangle `triangle` of `mesh` if emitters are
  /// selected by power.
  Pdf<Area> pdf(std::uint32_t mesh, std::uint32_t triangle) const;
  /// The point on an emitting surface hit by a path, as sample() would return it. `radiance`: its
  /// emission.
  EmitterPoint hit(const Surface& s, const Rgb& radiance) const;
  /// The unit direction `w` in which a path left the scene, as sample() would return it.
  EmitterPoint hit_background(const V3f& w) const;
  /// Radiance from direction `w` at infinity.
  Rgb background(const V3f& w) const;
  const Environment* environment() const { return environment_.get(); }
  /// The name of the mesh or light of an emitter (EmitterPoint::entry).
  std::string name(std::uint32_t entry) const;
  /// The number of texels, and sums of texels, read to estimate the power of textured triangles.
  std::uint64_t texels_read() const { return texels_read_; }

 private:
  static constexpr std::uint32_t none = ~0U;
  /// The common data of the entries of one mesh, or of the one entry of a light.
  struct Source {
    enum class Kind : std::uint8_t { mesh, punctual, environment } kind;
    bool both_sides = false;
    bool textured = false;    // emission varies over the surface
    bool colored = false;     // as vertex colours do
    Rgb emission{0, 0, 0};    // of a mesh
    std::uint32_t index = 0;  // index of the mesh or light
    std::uint32_t first_entry = 0;
    std::uint32_t mask = none;  // index in masks_
    double sides() const { return both_sides ? 2 : 1; }
  };
  /// A triangle or a light; sampling reads one cache line.
  struct alignas(64) Entry : TriangleShape {
    Pdf<Area> pdf{};  // including the selection
    std::uint32_t source = 0;
  };

  /// Means of the emission textures, by texture index; built at the first use.
  using MeansOfTextures = std::map<int, TextureMeans>;
  void add_mesh(std::uint32_t mesh, MeansOfTextures& means, std::vector<double>& powers);
  /// Mean luminance of the vertex colours of a triangle.
  static double mean_color(const Mesh& mesh, std::uint32_t triangle);
  double mean_luminance(const Mesh& mesh, std::uint32_t triangle, const TextureMeans& means);
  TreeEmitter tree_emitter(std::uint32_t entry, double power) const;
  std::vector<double> selection_weights(std::span<const double> powers) const;
  void select_pointwise(std::span<const double> powers);
  void add_light(const Source& source, double power, std::vector<double>& powers);
  /// sample() of an emitter other than a triangle.
  EmitterPoint sample_light(const Selected& selected) const;
  /// Emission at barycentric `b` of the chosen triangle, of a mesh with an emission texture or a
  /// mask. As a ray hits a blended point with probability alpha, so the point emits with that
  /// probability: all of what it emits, decided by the bits that chose it. Then paths that hit it
  /// and paths that sample it have the same contribution.
  Rgb varying_emission(const Source& source, const Selected& chosen, const V2f& b) const;
  EmitterPoint sample_environment(const Rng::FinePoint& at) const;
  EmitterPoint sample_punctual(const PunctualLight& light) const;
  float across(const V3f& w) const { return static_cast<float>(bounds_.area_across(w)); }

  const SceneData* scene_;
  Bounds bounds_;
  std::unique_ptr<Environment> environment_;
  std::vector<Source> sources_;
  HugeVector<Entry> entries_;
  std::vector<AlphaMask> masks_;  // of meshes with a mask: masked points do not emit
  AliasTable selection_;
  std::optional<PointwiseSelection> pointwise_;
  std::vector<std::uint32_t> first_entry_;  // of each mesh; none if it does not emit
  std::uint32_t environment_entry_ = none;
  std::uint64_t texels_read_ = 0;
};

}  // namespace lacuna
