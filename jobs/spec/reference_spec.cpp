#include "jobs/spec/reference_spec.h"

#include <fmt/format.h>

#include "jobs/spec/job_json.h"

namespace lacuna {
namespace {

/// The integrator that a reference of these settings is made with: converges to the same picture.
/// For all that measure light it is one and the same, so that they can be compared, and the one
/// that the fewest scenes defeat.
struct PlainIntegrator {
  template <class Settings>
  IntegratorSettings operator()(const Settings& s) const {
    BdptSettings plain;
    plain.max_depth = s.max_depth;
    return plain;
  }
  IntegratorSettings operator()(const InspectSettings& s) const { return s; }
};

// So that no random number of a reference is one of the job's own.
constexpr std::uint64_t reference_seed = 0x726566657265;  // below 2^53, the largest seed

}  // namespace

JobSpec reference_spec(const JobSpec& spec) {
  JobSpec r;
  r.scene = spec.scene;
  r.camera = spec.camera;
  r.label = "reference";
  r.resolution = spec.resolution;
  r.crop = spec.crop;
  r.integrator = std::visit(PlainIntegrator{}, spec.integrator);
  r.budget.iterations = spec.reference_iterations;
  // False colours show the analysis itself; light does not depend on it.
  if (std::holds_alternative<InspectSettings>(spec.integrator)) r.analysis = spec.analysis;
  r.environment = spec.environment;
  r.particles = spec.particles;
  r.material = spec.material;
  r.seed = reference_seed;
  r.threads = spec.threads;
  r.layers = {ImageLayer::variance, ImageLayer::halves};
  r.pixel_filter = spec.pixel_filter;
  return r;
}

std::string picture_name(const JobSpec& spec) {
  if (spec.reference.empty() || spec.reference == "auto") return picture_key(reference_spec(spec));
  std::string name =
      fmt::format("{} {}x{}", spec.reference, spec.resolution[0], spec.resolution[1]);
  if (const auto& c = spec.crop) {
    name += fmt::format(" of {}x{} from {},{}", c->of[0], c->of[1], c->from[0], c->from[1]);
  }
  return name;
}

}  // namespace lacuna
