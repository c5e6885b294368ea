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
    return for_each_tile(context, image, [&](const Tile& tile, Counters& counters) {
      Batch batch(settings_.max_depth);
      Walk walk(context.scene, guide_, {settings_.max_depth, settings_.roulette_depth}, counters);
      for (int first = 0; first < tile.pixels(); first += Batch::size) {
        batch.walkers.clear();
        for (int i = first; i < std::min(first + Batch::size, tile.pixels()); ++i) {
          batch.start(context, image, tile.pixel(i));
        }
        counters.samples += batch.walkers.size();
        estimate(context.scene, walk, batch);
        for (std::size_t i = 0; i < batch.walkers.size(); ++i) {
          accumulate(image.pixels[batch.pixels[i]], batch.radiance[i], counters);
        }
      }
      batch.shadows.flush(context.scene.rays(), counters,
                          [&](std::uint32_t pixel, const Rgb& value) {
                            accumulate(image.pixels[pixel], value, counters);
                          });
    });
  }

 private:
  /// Samples of neighbouring pixels that are walked together, and what they share.
  struct Batch {
    static constexpr int size = 64;  // their vertices fit the second-level cache

    explicit Batch(int max_depth)
        : places(static_cast<std::size_t>(max_depth) + 1), vertices(places * size) {
      walkers.reserve(size);
    }

    void start(const IterationContext& context, const Image& image, const V2i& pixel) {
      const CameraSample sample(context, image, pixel);
      const std::size_t i = walkers.size();
      const std::span<Vertex> path = std::span(vertices).subspan(i * places, places);
      path[0].kind = Vertex::Kind::eye;
      path[0].surface.x = sample.ray.o;
      // The film's measure of directions does not enter the walk: the eye's density and its
      // importance cancel.
      walkers.push_back({sample.rng, sample.ray, Pdf<SolidAngle>(1.0F), path});
      pixels[i] = static_cast<std::uint32_t>(image.index(pixel.x, pixel.y));
      radiance[i] = Rgb(0, 0, 0);
    }

    std::size_t places;
    std::vector<Vertex> vertices;
    std::vector<Walker> walkers;
    std::array<std::uint32_t, size> pixels{};
    std::array<Rgb, size> radiance{};          // what the paths themselves hit
    std::array<std::uint32_t, size> chosen{};  // the emitters of next event estimation
    ShadowQueue shadows;                       // and what they give
  };

  /// One sample of each pixel of `batch`, into its `radiance` and `shadows`.
  void estimate(const Scene& scene, Walk<Guide>& walk, Batch& batch) const {
    const auto choose_emitter = [&](std::size_t i, int depth) {
      if (nee(scene) && depth < settings_.max_depth) {
        batch.chosen[i] = scene.emitters().choose(batch.walkers[i].rng);
      }
    };
    const auto gather = [&](std::size_t i, int depth) {
      const Vertex& v = batch.walkers[i].path[static_cast<std::size_t>(depth)];
      const Vertex& from = batch.walkers[i].path[static_cast<std::size_t>(depth) - 1];
      batch.radiance[i] += emitter_hit(scene, v, from);
      const bool goes_on = v.kind == Vertex::Kind::surface && depth < settings_.max_depth;
      if (goes_on && nee(scene) && v.bsdf->connectible()) {
        const EmitterSample e =
            scene.emitters().sample(batch.chosen[i], v.surface.x, batch.walkers[i].rng);
        const Rgb value = direct(v, e);
        if (!is_black(value)) {
          batch.shadows.add(Scene::shadow_ray(v.surface, e), value, batch.pixels[i]);
        }
      }
    };
    walk.lead(batch.walkers, choose_emitter, gather);
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
