#pragma once

#include "base/json/json_text.h"
#include "jobs/store/job_folder.h"

namespace lacuna {

/// The cached references and artefacts: {"bytes", "entries": [{kind, name, bytes, used, ...}]},
/// largest first. `kind`: "reference" (a rendered or stored picture) or "artefact", whose `name` is
/// the type, with `file`, `key` and `label`, or `refused`: why it cannot be read. `used`: UTC of
/// the last write or read recorded by the file system. Throws std::system_error.
OrderedJson cache_listing(const DataRoot& data);

}  // namespace lacuna
