#pragma once

#include <string>

#include "jobs/report/sweep_pictures.h"

namespace lacuna {

/// A self-contained HTML file with the answers of a sweep, as on the service's page, and crops of
/// its pictures.
std::string report_html(const SweepFolder& sweep, const Answers& answers,
                        const SweepPictures& pictures);

}  // namespace lacuna
