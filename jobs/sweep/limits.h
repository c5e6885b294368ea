#pragma once

#include <cstddef>

namespace lacuna {

/// Size limits of the files of a run that are read, bytes.
inline constexpr std::size_t max_curve_bytes = std::size_t{256} << 20;
inline constexpr std::size_t max_report_bytes = std::size_t{4} << 20;

}  // namespace lacuna
