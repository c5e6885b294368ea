#pragma once

#include <string>

#include "base/json/json_text.h"

namespace lacuna {

/// Tables of the program for the page:
///
///     metrics         [{key, label, unit, slope, reference}], as error_metrics; a Monte Carlo
///                     estimate's error falls as samples^slope; reference: it needs one
///     notInAReference names of keys of a job, as the list of that name
///     inTheLight      pointers to the settings below "integrator" that change the light
OrderedJson page_tables();

/// page_tables() as the ES module /job_tables.js, which exports each table under its name.
std::string page_tables_module();

}  // namespace lacuna
