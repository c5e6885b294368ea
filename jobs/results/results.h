#pragma once

#include "jobs/run/render_loop.h"

namespace lacuna {

/// image.exr with the layers the job asks for, the same and the reference for the page's viewer,
/// image.png and curve.csv of a picture (DESIGN, "A job's folder"). Throws std::system_error or
/// std::runtime_error naming the file.
void write_results(const RenderTask& task, const RenderLoop& loop);

}  // namespace lacuna
