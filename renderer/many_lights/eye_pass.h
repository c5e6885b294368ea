#pragma once

#include <array>
#include <span>
#include <vector>

#include "renderer/many_lights/vpl_contributions.h"
#include "renderer/path/direct_light.h"
#include "renderer/path/emitter_selection.h"
#include "renderer/path/shadow_queue.h"
#include "renderer/path/tiles.h"
#include "renderer/settings/many_lights_settings.h"

namespace lacuna {

/// The eye paths of many-light rendering: finds the shading points of a tile, the first vertex of
/// each path for which Bsdf::is_vpl_receiver() holds, and adds the light that virtual lights do not
/// give: emission, direct light, and by path tracing what the bound of the geometric term removes
/// (Kollig and Keller 2004).
class VplEyePass {
 public:
  /// What all tiles of a pass share.
  struct Setting {
    const ManyLightsSettings& settings;
    float least_alpha;  ///< of metals that virtual lights illuminate
    const Guide& guide;
    const VplContributions& terms;
    bool first;  ///< the pass that adds this light; others only find the shading points
  };
  /// Working memory of a tile, for one after another.
  struct Memory {
    /// A contribution of next event estimation, pending its shadow ray.
    struct Direct {
      Rgb value;
      std::uint32_t path;
      int edges;
    };
    explicit Memory(int max_depth) : batch(max_depth) {}

    EyeBatch batch;
    std::array<int, EyeBatch::size> shaded = {};  ///< edges to the shading point; 0: none yet
    ShadowQueue<Direct> shadows = {};
    std::vector<ShadingPoint> points = {};
    std::vector<std::size_t> paths = {};  ///< of each of `points`
  };

  /// The references must outlive this.
  VplEyePass(const Setting& setting, const IterationContext& context, Memory& memory,
             Counters& counters)
      : setting_(setting),
        settings_(setting.settings),
        context_(context),
        memory_(memory),
        batch_(memory.batch),
        counters_(counters),
        direct_(context.scene, setting.guide, true, EmitterChoice::power),
        selection_(direct_.next_event(), direct_.active(), settings_.max_depth, batch_) {}

  /// Traces the paths of a tile's pixels. Afterwards the batch has the light of each path, and the
  /// memory the shading points.
  void trace(const Tile& tile, const Image& image);

 private:
  void contribute(std::size_t i, int edges, const Rgb& value);
  void trace_paths();
  bool visit(std::size_t i, int depth);
  float missing(const Vertex& at, const Vertex& to) const;
  Rgb emitted(const Vertex& v) const;
  void find_points();
  bool by_lights() const { return settings_.direct == DirectLighting::lights; }

  Setting setting_;
  const ManyLightsSettings& settings_;
  const IterationContext& context_;
  Memory& memory_;
  EyeBatch& batch_;
  Counters& counters_;
  DirectLight direct_;
  EmitterSelection selection_;
};

}  // namespace lacuna
