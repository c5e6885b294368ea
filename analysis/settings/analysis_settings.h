#pragma once

#include "analysis/settings/field.h"

namespace lacuna {

/// Shape analysis of the scene, for the integrators that use it.
struct AnalysisSettings {
  int resolution = 128;
  bool operator==(const AnalysisSettings&) const = default;
};
template <class V>
void describe(V& v, AnalysisSettings& s) {
  v("resolution", s.resolution,
    {.doc = "voxels along the longest side of the scene", .min = 1, .max = 2048, .unit = "voxels"});
}

}  // namespace lacuna
