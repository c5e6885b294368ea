#pragma once

#include <string_view>

#include "jobs/run/render_loop.h"

namespace lacuna {

/// The attribute of image.exr that says by which power of two its layer `variance` is multiplied:
/// 1, unless floats (or halves) could not hold the values.
inline constexpr std::string_view variance_scale_attribute = "variance_scale";

/// image.exr with the layers the job asks for, the same and the reference for the page's viewer,
/// image.png and curve.csv of a picture (DESIGN, "A job's folder"). Throws std::system_error or
/// std::runtime_error naming the file, and Stopped as RenderTask::stop_if_late().
void write_results(const RenderTask& task, const RenderLoop& loop);

}  // namespace lacuna
