#pragma once

#include <array>
#include <string>

#include "base/settings/field.h"

namespace lacuna {

/// Layers of image.exr besides the picture itself.
enum class ImageLayer {
  variance,
  halves,
  albedo,
  normal,
  depth,
  lengths,
  strategies,
  strategies_unweighted,
  distributions,
  visibility_tests,
  negative
};

template <>
struct EnumTable<ImageLayer> {
  static constexpr std::array<EnumValue<ImageLayer>, 11> values{{
      {ImageLayer::variance, "variance",
       "variance of the pixel's mean: from all iterations if they are independent, from the two "
       "halves with sampler `sobol`"},
      {ImageLayer::halves, "halves",
       "means of the even and of the odd iterations, two independent estimates"},
      {ImageLayer::albedo, "albedo", "base reflectance of the first hit"},
      {ImageLayer::normal, "normal", "shading normal of the first hit, world space"},
      {ImageLayer::depth, "depth", "distance to the first hit, scene units"},
      {ImageLayer::lengths, "lengths",
       "the light of each number of edges, one image for each up to max_depth: 1 = directly "
       "visible "
       "emitters, 2 = direct light; they sum to the picture"},
      {ImageLayer::strategies, "strategies",
       "weighted contribution of each strategy (s, t) of a bidirectional method: one image for "
       "each"},
      {ImageLayer::strategies_unweighted, "strategies_unweighted",
       "the same without MIS weights: each image estimates all light of its path length"},
      {ImageLayer::distributions, "distributions",
       "contribution of each resampling distribution to the picture"},
      {ImageLayer::visibility_tests, "visibility_tests",
       "fraction of the virtual lights whose visibility was tested by a ray"},
      {ImageLayer::negative, "negative",
       "fraction of the iterations in which the pixel was below 0"},
  }};
};

/// The layers that every integrator offers. Integrators whose settings list another layer fill it
/// (filled_layers()).
inline constexpr std::array common_layers{ImageLayer::variance, ImageLayer::halves,
                                          ImageLayer::albedo, ImageLayer::normal,
                                          ImageLayer::depth};

/// A layer of the light whose paths match an expression (path_expression.h).
struct LightPathsLayer {
  std::string light;
  std::string name;
  bool operator==(const LightPathsLayer&) const = default;
};
template <class V>
void describe(V& v, LightPathsLayer& s) {
  v("light", s.light,
    {.doc = "the paths, as a regular expression over E (eye), L (emitter) and what happens at each "
            "vertex between them: D (diffuse), G (glossy), S (mirror or clear glass). `E[DG]L` "
            "is direct light, `LS+DE` are caustics, `!EDL` is all but diffuse direct light",
     .min = 1,
     .max = 256,
     .required = true});
  v("name", s.name,
    {.doc = "name of the layer in image.exr, after `light.`: letters, digits, `_` and `-`",
     .min = 1,
     .max = 64,
     .required = true});
}

/// The most such layers of a job.
inline constexpr std::size_t most_light_paths_layers = 8;

/// The reconstruction filter of a pixel.
enum class PixelFilter { box, tent };

template <>
struct EnumTable<PixelFilter> {
  static constexpr std::array<EnumValue<PixelFilter>, 2> values{{
      {PixelFilter::box, "box", "the mean over the pixel's square"},
      {PixelFilter::tent, "tent", "falls off linearly to the centres of the neighbours"},
  }};
};

/// Precision of image.exr.
enum class PixelType { half_float, single_float };

template <>
struct EnumTable<PixelType> {
  static constexpr std::array<EnumValue<PixelType>, 2> values{{
      {PixelType::single_float, "float", "32 bits"},
      {PixelType::half_float, "half", "16 bits; an error if a value would overflow"},
  }};
};

}  // namespace lacuna
