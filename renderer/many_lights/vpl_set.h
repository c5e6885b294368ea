#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <variant>
#include <vector>

#include "base/parallel/thread_pool.h"
#include "renderer/many_lights/block_bounds.h"
#include "renderer/many_lights/lanes.h"
#include "renderer/path/light_batch.h"

namespace lacuna {

/// 64 lights as a structure of arrays: Lambertian surface vertices of light paths and one-sided
/// emitters, or point lights. Unused lanes are black. In unit direction `w` with w.g > 0 a light
/// has the radiant intensity rgb (w.g) (w.s > 0 ? shading_cosine_ratio : 1).
struct DiffuseBlock {
  bool points = false;         ///< point lights: intensity rgb in all directions, normals are 0
  Lanes x, y, z;               ///< position
  Lanes gx, gy, gz;            ///< unit geometric normal on the emitting side
  Lanes sx, sy, sz;            ///< unit shading normal on that side
  Lanes shading_cosine_ratio;  ///< LambertLobe::shading_cosine_ratio
  Lanes r, g, b;
  Lanes offset;  ///< ray_offset()
};

/// Position and normal of a virtual light.
struct VplGeometry {
  V3f x;          ///< position; unused for a light at infinity
  V3f n;          ///< unit normal on the emitting side; 0 for a point light
  bool infinite;  ///< at infinity
};

/// A light of any other kind: a vertex of a light path, or its start point on an emitter.
struct GeneralLight {
  std::variant<Vertex, EmitterPoint> at;
  int index;  ///< of the vertex on its path

  VplGeometry geometry() const;
  /// Whether eye paths cannot hit it.
  bool delta() const {
    const auto* e = std::get_if<EmitterPoint>(&at);
    return e != nullptr && e->delta();
  }
  /// Calls `use(endpoint)` with the endpoint of a connection edge (endpoints.h).
  template <class Use>
  decltype(auto) with_end(const Guide& guide, Use&& use) const {
    if (const auto* e = std::get_if<EmitterPoint>(&at)) return use(EmitterEndpoint{*e, guide});
    return use(SurfaceEndpoint{std::get<Vertex>(at), index, Transport::importance, guide});
  }
};

/// A range of blocks of lights.
struct BlockRange {
  std::size_t first = 0;
  std::size_t end = ~std::size_t{0};  ///< may exceed the number of blocks

  bool contains(std::size_t block) const { return block >= first && block < end; }
  /// Whether it is the first of the ranges that cover all blocks.
  bool is_first() const { return first == 0; }
};

/// Assigns a group to each light; all lights of a block belong to one group.
using LightGroup = std::uint64_t;
using LightGroups = std::function<LightGroup(const VplGeometry&)>;
/// The group of lights without a group.
inline constexpr std::uint32_t no_group = 0xffffffff;

/// The virtual point lights (VPLs) of an iteration, in blocks of 64 nearby lights. The intensity of
/// a light includes the factor 1 / number of light paths.
class VplSet {
 public:
  /// Selects the vertices of light paths that become lights.
  struct Choice {
    int longest;        ///< vertices 0 to `longest` - 1
    bool emitters;      ///< include vertex 0, the point on an emitter
    float least_alpha;  ///< of surfaces: Bsdf::is_vpl_receiver()
  };
  VplSet(std::size_t paths, const Choice& choice);

  /// Stores the lights of path `i` of `batch` as path number `path`: those of a part (light_pass.h)
  /// in order, parts by several threads at once.
  void keep(std::size_t path, const LightBatch& batch, std::size_t i);
  /// Sorts the lights into blocks; call it once, after all paths are stored. The order depends only
  /// on the paths and on `groups`, which several threads call.
  void arrange(const LightGroups& groups, const ThreadPool& pool);

  std::size_t size() const { return size_; }
  /// Blocks [0, blocks(edges)) contain the lights that are at most `edges` edges from their
  /// emitter.
  std::size_t blocks(int edges) const {
    if (edges < 0 || ends_.empty()) return 0;
    return ends_[std::min(static_cast<std::size_t>(edges), ends_.size() - 1)];
  }
  std::size_t blocks() const { return blocks_.size(); }
  /// The numbers of edges(): 0 to lengths() - 1.
  std::size_t lengths() const { return ends_.size(); }
  /// Edges between the lights of block `b` and their emitter.
  int edges(std::size_t b) const {
    return static_cast<int>(std::upper_bound(ends_.begin(), ends_.end(), b) - ends_.begin());
  }
  /// Number of lights of block `b`: 64, or fewer in the last block of a kind and group.
  int count(std::size_t b) const { return blocks_[b].count; }
  /// A mask of the lights of block `b`.
  std::uint64_t mask(std::size_t b) const {
    const int n = count(b);
    return n < Lanes::size ? (std::uint64_t{1} << n) - 1 : ~std::uint64_t{0};
  }
  /// The group of the lights of block `b`.
  LightGroup group(std::size_t b) const { return blocks_[b].group; }
  /// The bounds of block `b`; requires diffuse(b).
  const BlockBounds& bounds(std::size_t b) const { return bounds_[blocks_[b].first]; }
  /// The lights of block `b` if they are diffuse or point lights; else null.
  const DiffuseBlock* diffuse(std::size_t b) const {
    return blocks_[b].diffuse ? &diffuse_[blocks_[b].first] : nullptr;
  }
  /// Light `i` of block `b`; requires diffuse(b) == nullptr.
  const GeneralLight& general(std::size_t b, int i) const {
    return general_[blocks_[b].first + static_cast<std::size_t>(i)];
  }
  /// Position and normal of light `i` of block `b`.
  VplGeometry geometry(std::size_t b, int i) const;
  /// 1 / number of light paths; general lights do not include it.
  float share() const { return share_; }

 private:
  struct Diffuse {
    V3f x, ng, ns;
    float shading_cosine_ratio;
    Rgb rgb;
    float offset;
    VplGeometry geometry() const { return {x, ng, false}; }
  };
  struct StoredLights {
    std::vector<Diffuse> diffuse, points;
    std::vector<GeneralLight> general;
  };
  /// The lights of a part of the paths, by index of their vertex.
  using PartLights = std::vector<StoredLights>;
  struct Block {
    std::size_t first;  // in diffuse_ or general_
    int count;
    bool diffuse;
    LightGroup group;
  };

  void add(StoredLights& part, const EmitterPoint& e) const;
  void add(StoredLights& part, const Vertex& v, int index) const;

  Choice choice_;
  float share_;
  std::vector<PartLights> kept_;
  std::vector<DiffuseBlock> diffuse_;
  std::vector<BlockBounds> bounds_;  // of diffuse_
  std::vector<GeneralLight> general_;
  std::vector<Block> blocks_;
  std::vector<std::size_t> ends_;  // number of blocks of lights up to each number of edges
  std::size_t size_ = 0;
};

}  // namespace lacuna
