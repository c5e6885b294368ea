#pragma once

#include "base/json/json_text.h"
#include "jobs/store/job_folder.h"

namespace lacuna {

/// The cached references and artefacts: {"bytes", "entries": [{kind, name, bytes, used,
/// ...}]}, largest first. `kind`: "reference" (a rendered or stored picture) or "artefact", of
/// which `name` is the type, and `file`, `key` and `label` follow, or `refused`: why it cannot be
/// read. `used`: UTC, when it was last written or read, as far as the file system knows. Throws
/// std::system_error.
OrderedJson cache_listing(const DataRoot& data);

}  // namespace lacuna
