#pragma once

namespace lacuna::gltf {

/// Embree aborts on rays with coordinates above 1.8e18; leave room for sums of a few of them.
inline constexpr double max_coordinate = 1e15;
inline constexpr const char* coordinate_rule = "at most 1e15 in magnitude";

}  // namespace lacuna::gltf
