#pragma once

#include <string>

#include "analysis/json/json_text.h"

namespace lacuna {

/// What the page takes from the program's own tables:
///
///     metrics         [{key, label, unit, slope, reference}], as error_metrics; a Monte Carlo
///                     estimate's error falls as samples^slope; reference: it needs one
///     notInAReference names of keys of a job, as the list of that name
///     inTheLight      pointers to the settings below "integrator" that change the light
OrderedJson page_tables();

/// The same as the ES module /job_tables.js, which exports each under its name.
std::string page_tables_module();

}  // namespace lacuna
