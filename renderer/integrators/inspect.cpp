#include "renderer/integrators/integrators.h"

#include "renderer/integrators/inspect_guide.h"
#include "renderer/integrators/inspect_space.h"
#include "renderer/path/tiles.h"
#include "renderer/settings/inspect_settings.h"

namespace lacuna {

namespace {

class Inspect final : public Integrator {
 public:
  explicit Inspect(const InspectSettings& settings) : settings_(settings), show_(settings.show) {}

  SceneNeeds needs() const override {
    if (shows_guide(show_)) return GuideView::needs(settings_.guide);
    return {.materials = show_ == InspectQuantity::albedo,
            .emission = show_ == InspectQuantity::emission,
            .space = shows_space(show_)};
  }

  void prepare(const PrepareContext& context) override {
    if (shows_space(show_)) space_.emplace(show_, context);
    if (shows_guide(show_)) guide_.emplace(settings_, context);
  }

  Counters iterate(const IterationContext& context, Image& image) override {
    if (guide_) guide_->start(context, image);
    return for_each_tile(context, image, [&](const Tile& tile, Counters& counters) {
      for (int i = 0; i < tile.pixels(); ++i) {
        const V2i pixel = tile.pixel(i);
        const Ray ray = CameraSample(context, image.index(pixel.x, pixel.y)).ray;
        ++counters.samples;
        ++counters.rays;
        Hit hit;
        accumulate(image.at(pixel.x, pixel.y),
                   context.scene.rays().intersect(ray, hit) ? quantity(context, ray, hit, counters)
                                                            : background(context.scene, ray),
                   counters);
      }
    });
  }

 private:
  Rgb background(const Scene& scene, const Ray& ray) const {
    return show_ == InspectQuantity::emission ? scene.emitters().background(ray.d) : Rgb(0, 0, 0);
  }

  Rgb quantity(const IterationContext& context, const Ray& ray, const Hit& hit,
               Counters& counters) const {
    const Scene& scene = context.scene;
    const Surface s = scene.surface(ray, hit);
    if (guide_) return guide_->colour(scene, s, ray.d, context.seed, counters);
    if (space_) return space_->colour(scene, s, ray.d, context.seed, counters);
    switch (show_) {
      case InspectQuantity::normal:
        // The visible side.
        return dot(s.ng, ray.d) > 0 ? -s.ns : s.ns;
      case InspectQuantity::albedo: {
        std::optional<Bsdf> bsdf;
        scene.make_bsdf(s, bsdf);
        return bsdf->albedo();
      }
      case InspectQuantity::depth:
        return Rgb(hit.t);
      case InspectQuantity::emission:
        return scene.emitted(s, -ray.d);
      default:
        return {0, 0, 0};
    }
  }

  InspectSettings settings_;
  InspectQuantity show_;
  std::optional<SpaceView> space_;
  std::optional<GuideView> guide_;
};

}  // namespace

std::unique_ptr<Integrator> make_inspect(const InspectSettings& settings) {
  return std::make_unique<Inspect>(settings);
}

}  // namespace lacuna
