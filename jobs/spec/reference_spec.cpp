#include "jobs/spec/reference_spec.h"

namespace lacuna {
namespace {

struct ReferenceIntegrator {
  template <class Settings>
  JobIntegrator operator()(const Settings& s) const {
    BdptSettings plain;
    static_cast<PathLengths&>(plain) = without(LightLengths{s}, not_in_the_light);
    return plain;
  }
  JobIntegrator operator()(const InspectSettings& s) const { return s; }
};

}  // namespace

JobIntegrator reference_integrator(const JobIntegrator& integrator) {
  return std::visit(ReferenceIntegrator{}, integrator);
}

template JobSpec reference_spec(const JobSpec& job);
template std::string picture_name(const JobSpec& job);

}  // namespace lacuna
