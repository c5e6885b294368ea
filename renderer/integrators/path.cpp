#include "renderer/integrators/path.h"

#include "renderer/guides/bsdf_guide.h"
#include "renderer/integrators/tiles.h"
#include "renderer/path/connect.h"
#include "renderer/path/mis.h"
#include "renderer/path/shadow_queue.h"
#include "renderer/path/walk.h"

namespace lacuna {

namespace {

/// Path tracing (Noel 2015, 4.2): the strategies s = 0, an emitter hit by the walk, and s = 1, next
/// event estimation at every vertex, weighted against each other.
template <class Guide>
class Path final : public Integrator {
 public:
  Path(const PathSettings& settings, Guide guide) : settings_(settings), guide_(std::move(guide)) {}

  SceneNeeds needs() const override { return {.materials = true, .emission = true}; }

  Counters iterate(const IterationContext& context, Image& image) override {
    const auto vertices = static_cast<std::size_t>(settings_.max_depth) + 1;
    return for_each_pixel(
        context, image,
        [&] {
          return Scratch{std::vector<Vertex>(vertices), {}};
        },
        [&](int x, int y, Rng& rng, Counters& counters, Scratch& scratch) {
          const V2f u = rng.next2();
          const Ray ray =
              context.camera.ray(static_cast<float>(x) + u.x, static_cast<float>(y) + u.y);
          scratch.path[0].kind = Vertex::Kind::eye;
          scratch.path[0].surface.x = ray.o;
          return estimate(context.scene, ray, static_cast<std::uint32_t>(image.index(x, y)), rng,
                          scratch, counters);
        },
        [&](Scratch& scratch, Counters& counters) {
          scratch.shadows.flush(context.scene.rays(), counters,
                                [&](std::uint32_t pixel, const Rgb& value) {
                                  accumulate(image.pixels[pixel], value, counters);
                                });
        });
  }

 private:
  struct Scratch {
    std::vector<Vertex> path;
    ShadowQueue shadows;
  };

  /// The emitters that the path itself hits; what next event estimation finds waits in
  /// `scratch.shadows`.
  Rgb estimate(const Scene& scene, const Ray& ray, std::uint32_t pixel, Rng& rng, Scratch& scratch,
               Counters& counters) const {
    Rgb radiance(0, 0, 0);
    const WalkLimits limits{settings_.max_depth, settings_.roulette_depth};
    std::uint32_t chosen = 0;
    const auto choose_emitter = [&](int depth) {
      if (nee(scene) && depth < settings_.max_depth) chosen = scene.emitters().choose(rng);
    };
    const auto gather = [&](int depth) {
      const Vertex& v = scratch.path[static_cast<std::size_t>(depth)];
      radiance += emitter_hit(scene, v, scratch.path[static_cast<std::size_t>(depth) - 1]);
      const bool goes_on = v.kind == Vertex::Kind::surface && depth < settings_.max_depth;
      if (goes_on && nee(scene) && v.bsdf->connectible()) {
        const EmitterSample e = scene.emitters().sample(chosen, v.surface.x, rng);
        const Rgb value = direct(v, e);
        if (!is_black(value)) scratch.shadows.add(Scene::shadow_ray(v.surface, e), value, pixel);
      }
    };
    // The film's measure of directions does not enter walk(): the eye's density and its importance
    // cancel.
    walk(scene, ray, Pdf<SolidAngle>(1.0F), guide_, limits, rng, scratch.path, counters,
         choose_emitter, gather);
    return radiance;
  }

  bool nee(const Scene& scene) const {
    return settings_.next_event_estimation && !scene.emitters().empty();
  }

  StrategySet strategies() const {
    static constexpr std::array<double, 2> one_sample_each{1, 1};
    return {std::span(one_sample_each).first(settings_.next_event_estimation ? 2 : 1)};
  }

  /// s = 0: what `v` itself emits towards `from`.
  Rgb emitter_hit(const Scene& scene, const Vertex& v, const Vertex& from) const {
    const bool background = v.kind == Vertex::Kind::background;
    const Rgb emission =
        background ? scene.emitters().background(v.surface.x) : scene.emitted(v.surface, v.wp);
    if (is_black(emission)) return emission;
    const Pdf<Area> p_nee = background ? scene.emitters().environment_pdf(v.surface.x)
                                       : scene.emitters().pdf(v.surface.mesh, v.surface.triangle);
    const bool from_connectible =
        from.kind == Vertex::Kind::surface && !from.delta && from.bsdf->connectible();
    const std::array<VertexPdfs, 2> pdfs{
        {{p_nee.value, v.p_fwd.value, true}, {0, 0, from_connectible}}};
    return v.throughput * emission * static_cast<float>(mis_weight(pdfs, 0, strategies()));
  }

  /// s = 1: `v` joined to a point drawn on an emitter, if nothing lies between.
  Rgb direct(const Vertex& v, const EmitterSample& e) const {
    const Connection c = connect(v, e);
    if (is_black(c.contribution)) return c.contribution;
    const Pdf<Area> p_hit = to_area(guide_.pdf(v, c.w), c, e);
    const std::array<VertexPdfs, 2> pdfs{{{e.pdf.value, p_hit.value, true}, {0, 0, true}}};
    return c.contribution * static_cast<float>(mis_weight(pdfs, 1, strategies()));
  }

  PathSettings settings_;
  Guide guide_;
};

}  // namespace

std::unique_ptr<Integrator> make_path(const PathSettings& settings) {
  return std::visit(
      [&](const BsdfGuideSettings&) -> std::unique_ptr<Integrator> {
        return std::make_unique<Path<BsdfGuide>>(settings, BsdfGuide{});
      },
      settings.guide);
}

}  // namespace lacuna
