#pragma once

#include <vector>

#include "analysis/artefacts/record.h"
#include "base/json/json_text.h"

namespace lacuna {

/// The artefacts in a job's report: {"built": [...], "loaded": [...], "left_out": [NAME...]}.
/// Elements of the first two have {name, seconds, disk_bytes} and, if they apply, waited_seconds,
/// memory_bytes and remark.
OrderedJson artefacts_json(const std::vector<ArtefactRecord>& records);

}  // namespace lacuna
