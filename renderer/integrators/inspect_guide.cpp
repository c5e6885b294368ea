#include "renderer/integrators/inspect_guide.h"

#include "renderer/core/false_colour.h"
#include "renderer/guides/make_guide.h"
#include "renderer/integrators/integrators.h"
#include "renderer/integrators/path_tracer.h"

namespace lacuna {

GuideView::GuideView(const InspectSettings& settings, const PrepareContext& context)
    : settings_(settings) {
  tracer_ = std::make_unique<PathTracer>(PathSettings{}, make_guide(settings.guide));
  tracer_->prepare(context);
}

SceneNeeds GuideView::needs(const GuideSettings& guide) {
  PathSettings path;
  path.guide = guide;
  return make_path(path)->needs();
}

void GuideView::learn(const IterationContext& context, const Image& image) {
  for (; learned_ < settings_.learn; ++learned_) {
    Image ignored(image.width, image.height);
    IterationContext iteration = context;
    iteration.iteration = static_cast<std::uint64_t>(learned_);
    tracer_->iterate(iteration, ignored);
  }
}

Vertex GuideView::vertex(const Scene& scene, const Surface& s, const V3f& d) const {
  Vertex v;
  v.kind = Vertex::Kind::surface;
  v.surface = s;
  v.wp = -d;
  scene.make_bsdf(v.surface, v.bsdf);
  tracer_->guide().on_hit(v);
  return v;
}

void GuideView::start(const IterationContext& context, const Image& image) {
  learn(context, image);
  const Ray ray = context.camera.ray(static_cast<float>(settings_.from[0] * image.width),
                                     static_cast<float>(settings_.from[1] * image.height));
  Hit hit;
  point_.bsdf.reset();
  if (!context.scene.rays().intersect(ray, hit)) return;
  point_ = vertex(context.scene, context.scene.surface(ray, hit), ray.d);
}

Rgb GuideView::density(const Scene& scene, const Surface& s, const V3f& d,
                       Counters& counters) const {
  if (!point_.bsdf) return {0, 0, 0};
  const V3f towards = s.x - point_.surface.x;
  const float length = towards.length();
  if (!(length > 0)) return {0, 0, 0};
  const V3f w = towards / length;
  const V3f from = offset_origin(point_.surface.x, point_.surface.ng, point_.surface.offset, w);
  const V3f to = offset_end(s.x, s.ng, s.offset, -d, length);
  ++counters.shadow_rays;
  if (scene.rays().occluded({from, to - from, 1.0F})) return {0, 0, 0};
  return Rgb(tracer_->guide().pdf(point_, point_.wp, w, Transport::radiance).value);
}

Rgb GuideView::colour(const Scene& scene, const Surface& s, const V3f& d, std::uint64_t seed,
                      Counters& counters) const {
  if (settings_.show == InspectQuantity::guide_density) return density(scene, s, d, counters);
  const GuidingCell cell = vertex(scene, s, d).guiding_cell;
  if (settings_.show == InspectQuantity::guide_probability) return Rgb(cell.probability);
  return cell.index == GuidingCell{}.index ? Rgb(0, 0, 0) : false_colour(cell.index, seed);
}

}  // namespace lacuna
