#pragma once

#include <filesystem>

#include "jobs/spec/figure_spec.h"

namespace lacuna {

/// A figure of a sweep: its pictures as scenes, the settings that vary among a picture's cells as
/// methods (at most eight), and for each scene the two crops where the methods' relative errors
/// differ most, or without a reference their pictures. `sweep`: the sweep's folder; `name`: as the
/// file names it. Throws as FigureSource.
FigureSpec suggest_figure(const std::filesystem::path& sweep, const std::string& name);

}  // namespace lacuna
