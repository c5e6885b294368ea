#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "renderer/film/image.h"
#include "renderer/path/path_letters.h"
#include "renderer/settings/output_settings.h"

namespace lacuna {

/// The images of a picture's light by the number of edges of its paths, and by expressions over
/// their letters. Every contribution to the picture is added to the image of its length and to
/// those of the expressions that match its path.
class LightLayers {
 public:
  LightLayers() = default;
  /// `lengths`: one image for each number of edges up to `max_depth`. `paths`: valid expressions,
  /// at most 8.
  LightLayers(bool lengths, std::span<const LightPathsLayer> paths, int max_depth);

  /// The names of the images in image.exr: `lengths.1`, ..., then `light.NAME`.
  const std::vector<std::string>& names() const { return names_; }
  /// Of the expressions; null: there are none.
  const PathAutomaton* automaton() const { return automaton_ ? &*automaton_ : nullptr; }
  /// The number of images by length; they come first.
  std::size_t lengths() const { return lengths_; }

 private:
  std::vector<std::string> names_;
  std::size_t lengths_ = 0;
  std::optional<PathAutomaton> automaton_;
};

/// Where an iteration's contributions go besides the picture. Without layers all calls do nothing.
class LightSink {
 public:
  LightSink() = default;
  /// `images`: one for each name, of the picture's size.
  LightSink(const LightLayers& layers, std::span<Image> images)
      : layers_(layers.names().empty() ? nullptr : &layers), images_(images) {}

  explicit operator bool() const { return layers_ != nullptr; }
  const PathAutomaton* automaton() const {
    return layers_ != nullptr ? layers_->automaton() : nullptr;
  }
  /// The same sink for values that are `share` of what is added.
  LightSink times(float share) const {
    LightSink other = *this;
    other.share_ *= share;
    return other;
  }

  /// Adds a contribution of a path of `edges` edges. One that is not finite is dropped, as it is
  /// from the picture.
  void add(std::size_t pixel, int edges, PathMatches matches, const Rgb& value) const {
    if (layers_ != nullptr) [[unlikely]]
      add_to_images(pixel, edges, matches, value);
  }
  /// Adds the emission that the eye sees directly.
  void add_seen(std::size_t pixel, const Rgb& value) const {
    const PathAutomaton* letters = automaton();
    add(pixel, 1, letters != nullptr ? letters->matches(0, 0) : PathMatches{0}, value);
  }

 private:
  void add_to_images(std::size_t pixel, int edges, PathMatches matches, const Rgb& value) const;

  const LightLayers* layers_ = nullptr;
  std::span<Image> images_;
  float share_ = 1;
};

}  // namespace lacuna
