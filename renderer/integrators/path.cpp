#include "renderer/integrators/path.h"

#include "renderer/guides/bsdf_guide.h"
#include "renderer/integrators/tiles.h"
#include "renderer/path/connect.h"
#include "renderer/path/mis.h"
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
        context, image, [&] { return std::vector<Vertex>(vertices); },
        [&](int x, int y, Rng& rng, Counters& counters, std::vector<Vertex>& path) {
          const V2f u = rng.next2();
          const Ray ray =
              context.camera.ray(static_cast<float>(x) + u.x, static_cast<float>(y) + u.y);
          path[0].kind = Vertex::Kind::eye;
          path[0].surface.x = ray.o;
          return estimate(context.scene, ray, rng, path, counters);
        });
  }

 private:
  Rgb estimate(const Scene& scene, const Ray& ray, Rng& rng, std::span<Vertex> path,
               Counters& counters) const {
    Rgb radiance(0, 0, 0);
    const WalkLimits limits{settings_.max_depth, settings_.roulette_depth};
    // The film's measure of directions does not enter walk(): the eye's density and its importance
    // cancel.
    std::uint32_t chosen = 0;
    const auto choose_emitter = [&](int depth) {
      if (nee(scene) && depth < settings_.max_depth) chosen = scene.emitters().choose(rng);
    };
    const auto gather = [&](int depth) {
      const Vertex& v = path[static_cast<std::size_t>(depth)];
      const Vertex& from = path[static_cast<std::size_t>(depth) - 1];
      radiance += emitter_hit(scene, v, from);
      const bool goes_on = v.kind == Vertex::Kind::surface && depth < settings_.max_depth;
      if (goes_on && nee(scene) && v.bsdf->connectible()) {
        radiance += direct(scene, v, chosen, rng, counters);
      }
    };
    walk(scene, ray, Pdf<SolidAngle>(1.0F), guide_, limits, rng, path, counters, choose_emitter,
         gather);
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

  /// s = 1: `v` joined to a point drawn on an emitter.
  Rgb direct(const Scene& scene, const Vertex& v, std::uint32_t chosen, Rng& rng,
             Counters& counters) const {
    const EmitterSample e = scene.emitters().sample(chosen, v.surface.x, rng);
    const Connection c = connect(v, e);
    if (is_black(c.contribution)) return c.contribution;
    ++counters.shadow_rays;
    if (!scene.visible(v.surface, e)) return {0, 0, 0};
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
