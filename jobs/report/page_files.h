#pragma once

#include <string_view>

namespace lacuna {

/// The page's style, and web/report_page.js bundled with all modules that it imports. Generated
/// from these files by the build (jobs/report/bundle.py).
extern const std::string_view report_style;
extern const std::string_view report_script;

}  // namespace lacuna
