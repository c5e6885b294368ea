#pragma once

#include "renderer/integrators/integrator.h"
#include "renderer/path/guide.h"

namespace lacuna {

/// An integrator whose paths are sampled by a guide (renderer/guides): needs(), prepare(), save(),
/// load() and statistics() are those of the guide.
class GuidedIntegrator : public Integrator {
 public:
  explicit GuidedIntegrator(Guide guide) : guide_(std::move(guide)) {}

  SceneNeeds needs() const override {
    return {.materials = true, .emission = true, .space = guide_.needs_space()};
  }
  void prepare(const PrepareContext& context) override { guide_.prepare(context); }
  const Guide& guide() const { return guide_; }
  std::vector<std::pair<std::string, double>> statistics() const override {
    return guide_.statistics();
  }
  void save(ByteWriter& out) const override { guide_.save(out); }
  void load(ByteReader& in) override { guide_.load(in); }

 protected:
  Guide guide_;
};

}  // namespace lacuna
