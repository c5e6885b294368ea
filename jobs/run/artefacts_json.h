#pragma once

#include <vector>

#include "analysis/artefacts/record.h"
#include "base/json/json_text.h"

namespace lacuna {

/// What a job's report says of artefacts: {"built": [...], "loaded": [...], "left_out": [NAME...]}.
/// Each of the first two has {name, seconds, disk_bytes} and, where there is something to say,
/// waited_seconds, memory_bytes and remark.
OrderedJson artefacts_json(const std::vector<ArtefactRecord>& records);

}  // namespace lacuna
