#include "renderer/gltf/gltf_keyframes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lacuna::gltf {
namespace {

int accessor_of(const GltfObject& sampler, const char* key, const file::Model& model) {
  const auto index = sampler.index(key, model.accessors.size(), "accessors");
  if (!index) sampler.fail(std::string(key) + " is missing");
  return static_cast<int>(*index);
}

AccessorView output_of(const GltfObject& sampler, const file::Model& model, AnimatedKind kind) {
  const ElementType type = kind == AnimatedKind::vector     ? ElementType::vec3
                           : kind == AnimatedKind::rotation ? ElementType::vec4
                                                            : ElementType::scalar;
  return {model, accessor_of(sampler, "output", model), type,
          kind == AnimatedKind::vector ? Components::floats : Components::normalized,
          "output of " + sampler.label()};
}

std::vector<float> times_of(const GltfObject& sampler, const file::Model& model) {
  const AccessorView input(model, accessor_of(sampler, "input", model), ElementType::scalar,
                           Components::floats, "input of " + sampler.label());
  std::vector<float> times(input.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    times[i] = input.floats<1>(i)[0];
    if (std::isfinite(times[i]) && (i == 0 || times[i] >= times[i - 1])) continue;
    sampler.fail("the time of key " + std::to_string(i) + " is " + number_text(times[i]) +
                 "; allowed: finite ones that do not fall");
  }
  return times;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// The sum of `values`, each times its weight.
template <std::size_t N>
std::vector<double> blend(const std::array<std::vector<double>, N>& values,
                          const std::array<double, N>& weights) {
  std::vector<double> out(values[0].size(), 0.0);
  for (std::size_t n = 0; n < N; ++n) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += weights[n] * values[n][i];
  }
  return out;
}

}  // namespace

Keyframes::Keyframes(const GltfObject& sampler, const file::Model& model, AnimatedKind kind)
    : sampler_(sampler),
      kind_(kind),
      interpolation_(Interpolation::linear),
      times_(times_of(sampler, model)),
      values_(output_of(sampler, model, kind)) {
  const std::string name = sampler.string("interpolation", "LINEAR");
  if (name == "STEP") {
    interpolation_ = Interpolation::step;
  } else if (name == "CUBICSPLINE") {
    interpolation_ = Interpolation::cubic;
  } else if (name != "LINEAR") {
    sampler.refuse("interpolation", "\"LINEAR\", \"STEP\" or \"CUBICSPLINE\"");
  }
  const std::size_t parts = times_.size() * (interpolation_ == Interpolation::cubic ? 3 : 1);
  if (kind == AnimatedKind::weights) width_ = values_.size() / parts;
  if (width_ == 0 || parts * width_ != values_.size()) {
    sampler.fail("output has " + std::to_string(values_.size()) + " elements for " +
                 std::to_string(times_.size()) + " keys of " + name);
  }
}

std::vector<double> Keyframes::part(std::size_t key, Part which) const {
  const std::size_t first =
      (interpolation_ == Interpolation::cubic ? 3 * key + which : key) * width_;
  std::vector<double> out;
  const auto add = [&out](const auto& element) {
    out.insert(out.end(), element.begin(), element.end());
  };
  for (std::size_t i = first; i < first + width_; ++i) {
    if (kind_ == AnimatedKind::vector) add(values_.floats<3>(i));
    if (kind_ == AnimatedKind::rotation) add(values_.floats<4>(i));
    if (kind_ == AnimatedKind::weights) add(values_.floats<1>(i));
  }
  return out;
}

std::vector<double> Keyframes::slerp(std::size_t key, double u) const {
  const auto a = finished(part(key, value));
  auto b = finished(part(key + 1, value));
  double cosine = dot(a, b);
  if (cosine < 0) {  // the other quaternion of that rotation is nearer
    for (double& x : b) x = -x;
    cosine = -cosine;
  }
  constexpr double nearly_one = 1 - 1e-9;  // where the quotient of sines cancels
  if (cosine > nearly_one) return blend<2>({a, b}, {1 - u, u});
  const double angle = std::acos(cosine);
  return blend<2>(
      {a, b}, {std::sin((1 - u) * angle) / std::sin(angle), std::sin(u * angle) / std::sin(angle)});
}

std::vector<double> Keyframes::hermite(std::size_t key, double u, double seconds_between) const {
  const double uu = u * u;
  const double uuu = uu * u;
  return blend<4>(
      {part(key, value), part(key, out_tangent), part(key + 1, value), part(key + 1, in_tangent)},
      {2 * uuu - 3 * uu + 1, seconds_between * (uuu - 2 * uu + u), 3 * uu - 2 * uuu,
       seconds_between * (uuu - uu)});
}

std::vector<double> Keyframes::finished(std::vector<double> v) const {
  for (const double x : v) {
    if (!std::isfinite(x)) sampler_.fail("output has a value that is not finite");
  }
  if (kind_ != AnimatedKind::rotation) return v;
  const double length = std::sqrt(dot(v, v));
  if (!(length > 0)) sampler_.fail("output has a rotation of length 0; allowed: 1");
  for (double& x : v) x /= length;
  return v;
}

std::vector<double> Keyframes::at(double seconds) const {
  const auto after = std::upper_bound(times_.begin(), times_.end(), seconds,
                                      [](double t, float key) { return t < double(key); });
  if (after == times_.begin()) return finished(part(0, value));
  const auto key = static_cast<std::size_t>(after - times_.begin()) - 1;
  if (after == times_.end() || interpolation_ == Interpolation::step) {
    return finished(part(key, value));
  }
  const double between = double(times_[key + 1]) - double(times_[key]);
  const double u = (seconds - double(times_[key])) / between;  // `between` is above 0
  if (interpolation_ == Interpolation::cubic) return finished(hermite(key, u, between));
  if (kind_ == AnimatedKind::rotation) return finished(slerp(key, u));
  return finished(blend<2>({part(key, value), part(key + 1, value)}, {1 - u, u}));
}

}  // namespace lacuna::gltf
