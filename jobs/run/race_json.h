#pragma once

#include "base/json/json_text.h"
#include "renderer/race/record.h"

namespace lacuna {

/// A race as report.json tells it: the candidates with their errors and why they left, the rounds,
/// what was chosen and what error is expected of it.
OrderedJson race_json(const RaceRecord& race);

}  // namespace lacuna
