#pragma once

#include <string_view>

namespace lacuna {

/// The page's style and, as one script, the modules of web/report_page.js and all they import. Made
/// from these files when the program is built (jobs/report/bundle.py).
extern const std::string_view report_style;
extern const std::string_view report_script;

}  // namespace lacuna
