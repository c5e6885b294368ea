#pragma once

#include <stdexcept>
#include <type_traits>
#include <variant>

#include "jobs/spec/auto_settings.h"
#include "jobs/spec/foreign_settings.h"
#include "renderer/settings/integrator_settings.h"

namespace lacuna {

template <class... Ts>
std::variant<Ts..., AutoSettings, ForeignSettings> with_those_of_jobs(const std::variant<Ts...>&);

/// The `integrator` of a job: one of the renderer's, `auto`, or `foreign`.
using JobIntegrator = decltype(with_those_of_jobs(IntegratorSettings{}));

/// The same as a method of the renderer. Requires another alternative than `auto` and `foreign`.
inline IntegratorSettings method_of(const JobIntegrator& integrator) {
  return std::visit(
      []<class S>(const S& settings) -> IntegratorSettings {
        if constexpr (std::is_constructible_v<IntegratorSettings, const S&>) {
          return settings;
        } else {
          throw std::logic_error("auto and foreign are not methods of the renderer");
        }
      },
      integrator);
}
inline JobIntegrator job_integrator(const IntegratorSettings& method) {
  return std::visit([](const auto& settings) -> JobIntegrator { return settings; }, method);
}

}  // namespace lacuna
