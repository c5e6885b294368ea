#pragma once

#include <functional>
#include <string_view>

#include "jobs/run/reference.h"
#include "jobs/run/render_loop.h"
#include "renderer/images/exr_write.h"

namespace lacuna {

/// The attribute of image.exr with the power of two by which its layer `variance` is multiplied: 1,
/// unless floats (or halves) could not represent the values.
inline constexpr std::string_view variance_scale_attribute = "variance_scale";

/// Writes image.exr, image.png, and layers.half with layers.json for the page's viewer, which also
/// shows the reference, if there is one. The first layer is the picture. `between` is called during
/// long writes. Throws std::system_error or std::runtime_error naming the file.
void write_pictures(const JobFolder& folder, ExrPicture picture, const Reference* reference,
                    const std::function<void()>& between);

/// Writes image.exr with the layers of the job, the picture and the reference for the page's
/// viewer, image.png and curve.csv (docs/jobs.md). Throws std::system_error or std::runtime_error
/// naming the file, and Stopped as RenderTask::stop_if_late().
void write_results(const RenderTask& task, const RenderLoop& loop);

}  // namespace lacuna
