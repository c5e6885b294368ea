#include "jobs/spec/reference_spec.h"

namespace lacuna {
namespace {

struct ReferenceIntegrator {
  template <class Settings>
  IntegratorSettings operator()(const Settings& s) const {
    BdptSettings plain;
    static_cast<PathLengths&>(plain) = without(LightLengths{s}, not_in_the_light);
    return plain;
  }
  IntegratorSettings operator()(const InspectSettings& s) const { return s; }
};

}  // namespace

IntegratorSettings reference_integrator(const IntegratorSettings& integrator) {
  return std::visit(ReferenceIntegrator{}, integrator);
}

}  // namespace lacuna
