#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "renderer/core/alias_table.h"
#include "renderer/core/bounds.h"
#include "renderer/emitters/emitter_point.h"
#include "renderer/emitters/environment.h"
#include "renderer/emitters/leaving.h"
#include "renderer/geometry/alpha_mask.h"
#include "renderer/geometry/scene_data.h"
#include "renderer/geometry/surface.h"

namespace lacuna {

/// All emitters of a scene; one is chosen with probability proportional to its power, so the
/// density of any point on one is known wherever it is seen from.
class EmitterSet {
 public:
  /// `bounds` is the box of all triangles: the power of infinite emitters is what passes through
  /// the great disk of its sphere, and their light paths start on its sides. Keeps a pointer to
  /// `scene`; the emission textures and those of masks must be decoded.
  EmitterSet(const SceneData& scene, std::unique_ptr<Environment> environment,
             const Bounds& bounds);

  bool empty() const { return selection_.empty(); }
  std::size_t size() const { return entries_.size(); }

  /// Draws an emitter, before the receiver is known: its memory is then on its way while the ray to
  /// the receiver is traced. Not to be called when empty().
  std::uint32_t choose(Rng& rng) const { return choose(rng.next_u32(), rng); }
  /// By 32 uniform bits, and by one more number where two emitters share a place among them. Of as
  /// many equal steps as there are emitters of one power, each chooses another.
  std::uint32_t choose(std::uint32_t uniform, Rng& rng) const {
    const std::uint32_t i = selection_.resolve(selection_.choose(uniform), rng).index;
    __builtin_prefetch(&entries_[i]);
    return i;
  }
  /// Draws a point on the emitter `chosen`; its density includes the choice.
  EmitterPoint sample(std::uint32_t chosen, Rng& rng) const;
  /// A light path's first edge from such a point.
  std::optional<Leaving> leave(const EmitterPoint& e, Rng& rng) const {
    return sample_leaving(e, bounds_, rng);
  }

  /// Density with which sample() returns a point of triangle `triangle` of `mesh`.
  Pdf<Area> pdf(std::uint32_t mesh, std::uint32_t triangle) const;
  /// The point of an emitting surface that a path hit, as sample() would return it; its emission,
  /// which the caller has looked up, is `radiance`.
  EmitterPoint hit(const Surface& s, const Rgb& radiance) const;
  /// Direction `w` at infinity (unit), which a path ended in, as sample() would return it.
  EmitterPoint hit_background(const V3f& w) const;
  /// Radiance that arrives from direction `w` at infinity.
  Rgb background(const V3f& w) const;
  const Environment* environment() const { return environment_.get(); }

 private:
  static constexpr std::uint32_t none = ~0U;
  /// What the entries of one mesh, or the only entry of a light, have in common.
  struct Source {
    enum class Kind : std::uint8_t { mesh, punctual, environment } kind;
    bool both_sides = false;
    bool textured = false;    // emission is not the same everywhere
    Rgb emission{0, 0, 0};    // of a mesh
    std::uint32_t index = 0;  // of the mesh or of the light
    std::uint32_t first_entry = 0;
    std::uint32_t mask = none;  // in masks_
  };
  /// A triangle or a light; what a draw needs lies in one cache line.
  struct alignas(64) Entry : TriangleShape {
    Pdf<Area> pdf{};  // selection included
    std::uint32_t source = 0;
  };

  void add_mesh(std::uint32_t mesh, std::vector<double>& powers);
  void add_light(const Source& source, double power, std::vector<double>& powers);
  EmitterPoint sample_triangle_of(std::uint32_t chosen, const V2f& u) const;
  EmitterPoint sample_environment(Rng& rng) const;
  EmitterPoint sample_punctual(const PunctualLight& light) const;
  float across(const V3f& w) const { return static_cast<float>(bounds_.area_across(w)); }

  const SceneData* scene_;
  Bounds bounds_;
  std::unique_ptr<Environment> environment_;
  std::vector<Source> sources_;
  HugeVector<Entry> entries_;
  std::vector<AlphaMask> masks_;  // of meshes that have one: what is not there does not shine
  AliasTable selection_;
  std::vector<std::uint32_t> first_entry_;  // of each mesh; none: it does not emit
  std::uint32_t environment_entry_ = none;
};

}  // namespace lacuna
