#include "tests/renderer/path/oracle.h"

#include <numbers>

namespace lacuna::test {

namespace {

double cosine(const V3f& n, const V3f& w) { return std::abs(V3d(n).dot(V3d(w))); }

double squared_distance(const WholePath& p, int i) {
  return (V3d(p.x(i + 1)) - V3d(p.x(i))).length2();
}

/// Density of `w` after `wo` where `directions` are mixed with the BSDF.
double mixed(const GuidingDistribution* directions, const Surface& s, const Bsdf& b, const V3f& wo,
             const V3f& w, double bsdf) {
  if (directions == nullptr) return bsdf;
  const GuidingCell cell = directions->cell(s, wo);
  const auto guided = double(directions->pdf({s, b, wo, cell}, w).value);
  const auto c = double(cell.probability);
  return c * guided + (1 - c) * bsdf;
}

}  // namespace

Oracle::Oracle(const Scene& scene, const Camera& camera, const WholePath& path,
               const DirectionsOf& directions)
    : scene_(scene), camera_(camera), path_(path), directions_(directions) {
  const int k = path.edges();
  for (int i = 0; i <= k; ++i) {
    from_light_.push_back(i == k ? -HUGE_VAL : std::log(light_step(i)));
    from_eye_.push_back(i == k ? 0 : std::log(eye_step(i)));
  }
}

/// Density with which light paths leave the emitter along `w`.
double Oracle::pdf_Le(const V3f& w) const {
  const EmitterPoint& e = path_.emitter;
  const double c = V3d(e.ng).dot(V3d(w));
  switch (e.kind) {
    case EmitterPoint::Kind::area: {
      if (e.both_sides) return std::abs(c) / (2 * std::numbers::pi);
      Surface s;
      s.x = e.x;
      s.ng = s.ns = e.ng;
      const Lobes white{SurfaceParams{}};
      return mixed(directions_.light, s, Bsdf(white, e.ng, e.ng), e.ng, w,
                   std::max(c, 0.0) / std::numbers::pi);
    }
    case EmitterPoint::Kind::point:
      return 1 / (4 * std::numbers::pi);
    case EmitterPoint::Kind::spot:
      return double(e.pdf_Le(w).value);  // tests/renderer/emitters checks it
    default: {
      // Uniform over the silhouette of the box.
      const V3d d = scene_.bounds().size();
      return 1 / (d.y * d.z * std::abs(double(w.x)) + d.z * d.x * std::abs(double(w.y)) +
                  d.x * d.y * std::abs(double(w.z)));
    }
  }
}

/// Density per area of x_i, 0 <= i < k, of a path that comes from the light.
double Oracle::light_step(int i) const {
  if (i == 0) return double(path_.emitter.pdf.value);
  const V3f& w = path_.towards_eye(i - 1);
  const double c = cosine(path_.node(i).surface.ng, w);
  if (i == 1 && path_.emitter.infinite()) return pdf_Le(w) * c;
  const double there = c / squared_distance(path_, i - 1);
  if (i == 1) return pdf_Le(w) * there;
  const WholePath::Node& from = path_.node(i - 1);
  if (from.delta) return there;
  const V3f wo = -path_.towards_eye(i - 2);
  const auto bsdf = double(from.bsdf->pdf(wo, w, Transport::importance).value);
  return mixed(directions_.light, from.surface, *from.bsdf, wo, w, bsdf) * there;
}

/// The same of a path that comes from the eye.
double Oracle::eye_step(int i) const {
  const V3f w = -path_.towards_eye(i);
  double there = 1;  // to infinity: per steradian
  if (i > 0) {
    there = cosine(path_.node(i).surface.ng, w) / squared_distance(path_, i);
  } else if (!path_.emitter.infinite()) {
    const bool area = path_.emitter.kind == EmitterPoint::Kind::area;
    there = (area ? cosine(path_.emitter.ng, w) : 1.0) / squared_distance(path_, 0);
  }
  if (i == path_.edges() - 1) return double(camera_.density(w).value) * there;
  const WholePath::Node& from = path_.node(i + 1);
  if (from.delta) return there;
  const V3f& wo = path_.towards_eye(i + 1);
  const auto bsdf = double(from.bsdf->pdf(wo, w, Transport::radiance).value);
  return mixed(directions_.eye, from.surface, *from.bsdf, wo, w, bsdf) * there;
}

/// Logarithm of the density with which a walk makes the first `from_light` vertices and one from
/// the eye the last `from_eye`.
double Oracle::product(int from_light, int from_eye) const {
  double sum = 0;
  const int k = path_.edges();
  for (int i = 0; i < from_light; ++i) sum += from_light_[static_cast<std::size_t>(i)];
  for (int i = k + 1 - from_eye; i <= k; ++i) sum += from_eye_[static_cast<std::size_t>(i)];
  return sum;
}

std::vector<double> Oracle::weights(const SampleCounts& n, double next_event_ratio) const {
  const int k = path_.edges();
  std::vector<double> logs;
  for (int s = 0; s <= k; ++s) {
    const int t = k + 1 - s;
    const bool possible = s == 0 ? !path_.emitter.delta() : path_.joins(s);
    double samples = n.connect;
    if (s == 0) {
      samples = n.hit;
    } else if (t == 1) {
      samples = n.splat;
    } else if (s == 1) {
      samples = n.nee * next_event_ratio;
    }
    logs.push_back(possible ? std::log(samples) + product(s, t) : -HUGE_VAL);
  }
  for (int j = 1; j < k; ++j) {  // both walks come to x_j, within the disc that n.merge contains
    const bool possible = !path_.node(j).delta;
    logs.push_back(possible ? std::log(n.merge) + product(j + 1, k + 1 - j) : -HUGE_VAL);
  }
  const double largest = *std::max_element(logs.begin(), logs.end());
  double all = 0;
  std::vector<double> weights(logs.size(), 0.0);
  if (largest == -HUGE_VAL) return weights;
  for (const double l : logs) all += std::exp(l - largest);
  for (std::size_t s = 0; s < logs.size(); ++s) weights[s] = std::exp(logs[s] - largest) / all;
  return weights;
}

}  // namespace lacuna::test
