#pragma once

#include <optional>
#include <string>
#include <vector>

#include "renderer/settings/integrator_settings.h"

namespace lacuna::extremes {

/// A column of the matrix: one way to make a picture.
struct Method {
  std::string name;  ///< as a job file would say it: "path next_event_estimation=false"
  IntegratorSettings settings;
};

/// Every registered integrator with every strategy that its tables offer, and, if `flags`, each of
/// these with every flag and named value changed, one at a time. Read from the registry and its
/// tables alone: what is registered is here.
std::vector<Method> methods(bool flags);

/// The longest path in edges, where the method's table has `max_depth` and its settings are neither
/// biased nor of unbounded variance: then it estimates the light that arrives along paths of at
/// most so many edges (DESIGN, "Words").
std::optional<int> max_depth(const Method& method);

/// The first of all methods, with the same longest path: follows light, and must show the same.
Method reference_for(const Method& method);

/// Whether the method's settings say that it samples nothing from the eye.
inline bool from_lights_only(const Method& method) {
  return lacuna::from_lights_only(method.settings);
}

/// Which end of a number's range.
enum class End { below, lowest, highest, above };

/// The method with each number of its tables, one at a time, at the given end of its range; `below`
/// and `above` are not allowed any more. A range without an end gives nothing.
std::vector<Method> with_numbers_at(const Method& method, End end);

}  // namespace lacuna::extremes
