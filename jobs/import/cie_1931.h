#pragma once

#include <array>

#include "renderer/core/vec.h"

namespace lacuna {

/// The colour matching functions of the CIE's 2-degree observer of 1931, each 5 nm from 380 to 780
/// nm.
extern const std::array<V3d, 81> cie_1931;
inline constexpr double cie_1931_from = 380, cie_1931_step = 5;

}  // namespace lacuna
