#pragma once

#include <string>
#include <vector>

#include "base/json/json_text.h"
#include "jobs/run/prepare.h"
#include "renderer/path/path_observer.h"

namespace lacuna {

/// The paths that have made a pixel in some iterations of a job.
struct PixelPaths {
  std::array<int, 2> pixel{};  ///< column and row, from the upper left
  std::uint64_t samples = 0;   ///< iterations
  std::uint64_t seed = 0;
  /// The mean of `paths` over the iterations: what the job's picture has in the pixel after these.
  V3d mean{0, 0, 0};
  /// All that contributed, the brightest first. Positions are in the renderer's coordinates.
  std::vector<TracedPath> paths;
};

/// Why the paths of a job with this integrator cannot be traced, as the continuation of "found ...,
/// which "; empty if they can.
std::string_view without_traces(const JobIntegrator& integrator);

/// Renders the first `samples` iterations of the job as its render does, of `path` without a guide
/// that learns only the tile around the pixel, and returns the paths that contributed to `pixel`.
/// Requires analyse(). Throws BadJob if the pixel is outside the picture, if the job has fewer
/// iterations or its method cannot be traced, and Stopped.
PixelPaths trace_pixel(const JobSpec& spec, const Prepared& prepared,
                       const std::array<int, 2>& pixel, std::uint64_t samples,
                       const std::function<bool()>& stop);

/// As one JSON object, in the coordinates of the scene's file. `brightest`: number of paths.
OrderedJson pixel_paths_json(const PixelPaths& found, const SceneData& scene,
                             std::size_t brightest);

}  // namespace lacuna
