#include "renderer/integrators/inspect_guide.h"

#include "renderer/guides/make_guide.h"
#include "renderer/settings/inspect_settings.h"

namespace lacuna {

GuideView::GuideView(const InspectSettings& settings, const PrepareContext& context)
    : from_(settings.from) {
  with_guide(settings.guide, [&]<class Guide>(Guide guide) {
    guide.prepare(context);
    const auto shared = std::make_shared<const Guide>(std::move(guide));
    on_hit_ = [shared](Vertex& v) { shared->on_hit(v); };
    density_ = [shared](const Vertex& v, const V3f& w) {
      return shared->pdf(v, v.wp, w, Transport::radiance).value;
    };
  });
}

void GuideView::start(const IterationContext& context, const Image& image) {
  const Ray ray = context.camera.ray(static_cast<float>(from_[0] * image.width),
                                     static_cast<float>(from_[1] * image.height));
  Hit hit;
  point_.bsdf.reset();
  if (!context.scene.rays().intersect(ray, hit)) return;
  point_.kind = Vertex::Kind::surface;
  point_.surface = context.scene.surface(hit);
  point_.wp = -ray.d;
  context.scene.make_bsdf(point_.surface, point_.bsdf);
  on_hit_(point_);
}

Rgb GuideView::colour(const Scene& scene, const Surface& s, const V3f& d,
                      Counters& counters) const {
  if (!point_.bsdf) return {0, 0, 0};
  const V3f towards = s.x - point_.surface.x;
  const float length = towards.length();
  if (!(length > 0)) return {0, 0, 0};
  const V3f w = towards / length;
  const V3f from = offset_origin(point_.surface.x, point_.surface.ng, point_.surface.extent, w);
  const V3f to = offset_origin(s.x, s.ng, s.extent, -d);
  ++counters.shadow_rays;
  if (scene.rays().occluded({from, to - from, 1.0F})) return {0, 0, 0};
  return Rgb(density_(point_, w));
}

}  // namespace lacuna
