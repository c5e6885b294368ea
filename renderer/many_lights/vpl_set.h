#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <variant>
#include <vector>

#include "renderer/many_lights/block_bounds.h"
#include "renderer/many_lights/lanes.h"
#include "renderer/path/light_batch.h"

namespace lacuna {

/// Lambertian surfaces that a light path met, and one-sided emitters, or else point lights:
/// sixty-four lights side by side. What is missing of the sixty-four is black. Towards unit `w`
/// with w.g > 0 each sends radiant intensity rgb (w.g) (w.s > 0 ? shading_cosine_ratio : 1).
struct DiffuseBlock {
  bool points = false;         ///< it sends rgb everywhere, and all normals are 0
  Lanes x, y, z;               ///< position
  Lanes gx, gy, gz;            ///< unit geometric normal, on the side that shines
  Lanes sx, sy, sz;            ///< unit shading normal on that side
  Lanes shading_cosine_ratio;  ///< LambertLit::shading_cosine_ratio
  Lanes r, g, b;
  Lanes extent;  ///< of the triangle, see TriangleShape
};

/// Where a light stands.
struct VplGeometry {
  V3f x;          ///< position; not of a light at infinity
  V3f n;          ///< unit normal on the side that shines; 0 of a point light
  bool infinite;  ///< it shines from outside the scene
};

/// A light of any other kind: a light path's vertex or the point on an emitter where it starts.
struct GeneralLight {
  std::variant<Vertex, EmitterPoint> at;
  int index;  ///< of the vertex on its path

  VplGeometry geometry() const;
  /// No path can hit it.
  bool delta() const {
    const auto* e = std::get_if<EmitterPoint>(&at);
    return e != nullptr && e->delta();
  }
  /// Calls `use(end)` with the end of a connecting edge (ends.h).
  template <class Guide, class Use>
  decltype(auto) with_end(const Guide& guide, Use&& use) const {
    if (const auto* e = std::get_if<EmitterPoint>(&at)) return use(EmitterEndpoint{*e});
    return use(SurfaceEndpoint<Guide>{std::get<Vertex>(at), index, Transport::importance, guide});
  }
};

/// Blocks of lights that are treated together.
struct BlockRange {
  std::size_t first = 0;
  std::size_t end = ~std::size_t{0};  ///< or the number of blocks, if that is less

  bool contains(std::size_t block) const { return block >= first && block < end; }
  /// Of the ranges of all blocks, one after another, it is the first.
  bool is_first() const { return first == 0; }
};

/// Lights that are treated alike have one number: the lights of a block are of one group.
using LightGroups = std::function<std::uint32_t(const VplGeometry&)>;
/// Of a light that belongs nowhere.
inline constexpr std::uint32_t no_group = 0xffffffff;

/// The virtual point lights of an iteration, in blocks of sixty-four; those of a block lie near one
/// another. The contribution of a light already holds 1 / the number of light paths.
class VplSet {
 public:
  /// Which vertices of light paths are lights.
  struct Choice {
    int longest;        ///< of vertices 0 to `longest` - 1
    bool emitters;      ///< vertex 0 too, the point on an emitter
    float least_alpha;  ///< of the surfaces: Bsdf::is_vpl_receiver()
  };
  VplSet(std::size_t paths, const Choice& choice)
      : choice_(choice), share_(1.0F / float(paths)), kept_(paths) {}

  /// Keeps the path in place `i` of `batch` as path number `path`. Different paths may be kept by
  /// several threads at once.
  template <class Guide>
  void keep(std::size_t path, const LightBatch<Guide>& batch, std::size_t i) {
    const int length = std::min(batch.length(i), choice_.longest);
    if (length > 0 && choice_.emitters) add(kept_[path], batch.emitter(i));
    for (int index = 1; index < length; ++index) {
      const Vertex& v = batch.vertex(i, index);
      if (v.bsdf->is_vpl_receiver(choice_.least_alpha)) add(kept_[path], v, index);
    }
  }
  /// To be called when all paths are kept. The order of the lights depends on the paths and on
  /// `groups` only.
  void arrange(const LightGroups& groups);

  std::size_t size() const { return size_; }
  /// Blocks [0, blocks(edges)) hold the lights that are at most `edges` edges from their emitter.
  std::size_t blocks(int edges) const {
    if (edges < 0 || ends_.empty()) return 0;
    return ends_[std::min(static_cast<std::size_t>(edges), ends_.size() - 1)];
  }
  std::size_t blocks() const { return blocks_.size(); }
  /// Lights of block `b`: 64 but for a last one of its kind.
  int count(std::size_t b) const { return blocks_[b].count; }
  /// The group that all lights of block `b` are of.
  std::uint32_t group(std::size_t b) const { return blocks_[b].group; }
  /// Of block `b`, whose lights are diffuse.
  const BlockBounds& bounds(std::size_t b) const { return bounds_[blocks_[b].first]; }
  /// The lights of block `b`, if they are diffuse; else null.
  const DiffuseBlock* diffuse(std::size_t b) const {
    return blocks_[b].diffuse ? &diffuse_[blocks_[b].first] : nullptr;
  }
  /// Light `i` of block `b`, which is not diffuse.
  const GeneralLight& general(std::size_t b, int i) const {
    return general_[blocks_[b].first + static_cast<std::size_t>(i)];
  }
  /// Where light `i` of block `b` stands.
  VplGeometry geometry(std::size_t b, int i) const;
  /// 1 / the number of light paths, which general lights do not hold.
  float share() const { return share_; }

 private:
  struct Diffuse {
    V3f x, ng, ns;
    float shading_cosine_ratio;
    Rgb rgb;
    float extent;
    int index;
  };
  struct Kept {
    std::vector<Diffuse> diffuse, points;
    std::vector<GeneralLight> general;
  };
  struct Block {
    std::size_t first;  // in diffuse_ or general_
    int count;
    bool diffuse;
    std::uint32_t group;
  };

  void add(Kept& path, const EmitterPoint& e) const;
  void add(Kept& path, const Vertex& v, int index) const;
  void arrange_diffuse(const std::vector<Diffuse>& lights, bool points, const LightGroups& groups);
  void arrange_general(const std::vector<GeneralLight>& lights, const LightGroups& groups);

  Choice choice_;
  float share_;
  std::vector<Kept> kept_;
  std::vector<DiffuseBlock> diffuse_;
  std::vector<BlockBounds> bounds_;  // of those
  std::vector<GeneralLight> general_;
  std::vector<Block> blocks_;
  std::vector<std::size_t> ends_;  // blocks of lights up to each number of edges
  std::size_t size_ = 0;
};

}  // namespace lacuna
