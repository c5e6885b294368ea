#include "renderer/path/light_layers.h"

#include <fmt/format.h>

namespace lacuna {

LightLayers::LightLayers(bool lengths, std::span<const LightPathsLayer> paths, int max_depth)
    : lengths_(lengths ? static_cast<std::size_t>(max_depth) : 0) {
  for (std::size_t k = 1; k <= lengths_; ++k) {
    names_.push_back(fmt::format("{}.{}", enum_name(ImageLayer::lengths), k));
  }
  if (paths.empty()) return;
  std::vector<PathExpression> expressions;
  for (const LightPathsLayer& p : paths) {
    names_.push_back(fmt::format("light.{}", p.name));
    expressions.push_back(path_expression(p.light));
  }
  automaton_.emplace(expressions);
}

void LightSink::add_to_images(std::size_t pixel, int edges, PathMatches matches,
                              const Rgb& value) const {
  if (!is_finite(value)) return;
  const Rgb part = value * share_;
  if (layers_->lengths() > 0) images_[static_cast<std::size_t>(edges) - 1].pixels[pixel] += part;
  for (std::size_t k = layers_->lengths(); matches != 0; ++k, matches >>= 1) {
    if ((matches & 1) != 0) images_[k].pixels[pixel] += part;
  }
}

}  // namespace lacuna
