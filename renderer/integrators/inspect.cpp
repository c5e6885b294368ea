#include "renderer/integrators/inspect.h"

#include "renderer/integrators/tiles.h"
#include "renderer/materials/gltf_material.h"

namespace lacuna {

namespace {

class Inspect final : public Integrator {
 public:
  explicit Inspect(const InspectSettings& settings) : show_(settings.show) {}

  SceneNeeds needs() const override {
    return {.materials = show_ == InspectQuantity::albedo,
            .emission = show_ == InspectQuantity::emission};
  }

  Counters iterate(const IterationContext& context, Image& image) override {
    return for_each_pixel(
        context, image, [] { return 0; },
        [&](int x, int y, Rng& rng, Counters& counters, int) {
          const V2f u = rng.next2();
          const Ray ray =
              context.camera.ray(static_cast<float>(x) + u.x, static_cast<float>(y) + u.y);
          ++counters.rays;
          Hit hit;
          return context.scene.rays().intersect(ray, hit)
                     ? quantity(context.scene, context.scene.surface(hit), ray, hit)
                     : background(context.scene, ray);
        },
        [](int, Counters&) {});
  }

 private:
  Rgb background(const Scene& scene, const Ray& ray) const {
    return show_ == InspectQuantity::emission ? scene.emitters().background(ray.d) : Rgb(0, 0, 0);
  }

  Rgb quantity(const Scene& scene, const Surface& s, const Ray& ray, const Hit& hit) const {
    switch (show_) {
      case InspectQuantity::normal:
        // The side that is seen.
        return dot(s.ng, ray.d) > 0 ? -s.ns : s.ns;
      case InspectQuantity::albedo: {
        const Bsdf bsdf(surface_params(scene.material(s), scene.data().textures, s.uv), s.ng, s.ns);
        return bsdf.albedo();
      }
      case InspectQuantity::depth:
        return Rgb(hit.t);
      case InspectQuantity::emission:
        return scene.emitted(s, -ray.d);
    }
    return {0, 0, 0};
  }

  InspectQuantity show_;
};

}  // namespace

std::unique_ptr<Integrator> make_inspect(const InspectSettings& settings) {
  return std::make_unique<Inspect>(settings);
}

}  // namespace lacuna
