#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/storage/bytes.h"
#include "renderer/path/contexts.h"
#include "renderer/path/counters.h"
#include "renderer/settings/integrator_settings.h"
#include "renderer/settings/output_settings.h"

namespace lacuna {

/// A rendering method. iterate() is a pure function of the scene, the settings, the seed, the
/// iteration and the state that save() writes. A stopped iteration does not change that state.
class Integrator {
 public:
  virtual ~Integrator() = default;

  virtual SceneNeeds needs() const = 0;
  /// Called once, before everything else but needs(). Its time, with the artefacts that it requests
  /// from `space`, is charged to the job's preparation.
  virtual void prepare(const PrepareContext&) {}
  /// Names in image.exr of the images that the integrator fills beside the picture for the layers
  /// `wanted`. Called once, after prepare() and before the first iteration. iterate() then finds
  /// one image for each name in IterationContext::layers and adds only finite values to it. The
  /// settings list the layers that an integrator fills (filled_layers()).
  virtual std::vector<std::string> layers(std::span<const ImageLayer> /*wanted*/) { return {}; }
  /// Renders one more estimate of the whole picture into `image` (of the film's size, black). The
  /// estimates are independent, unless IterationContext::sampler stratifies them.
  virtual Counters iterate(const IterationContext& context, Image& image) = 0;
  /// Names and numbers for the report, of this process' iterations.
  virtual std::vector<std::pair<std::string, double>> statistics() const { return {}; }
  /// Learned state, for the checkpoint.
  virtual void save(ByteWriter&) const {}
  virtual void load(ByteReader&) {}
};

/// The integrator of the given settings: the registry.
std::unique_ptr<Integrator> make_integrator(const IntegratorSettings& settings);

}  // namespace lacuna
