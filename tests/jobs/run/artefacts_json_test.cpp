#include "jobs/run/artefacts_json.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/json/json_text.h"

namespace lacuna {
namespace {

using Origin = ArtefactRecord::Origin;

TEST(ArtefactsJson, TellsWhatBecameOfEachRequest) {
  const std::vector<ArtefactRecord> records{
      {"skeleton", Origin::built, 1.5, 0, 100, 400, ""},
      {"portals", Origin::not_needed, 0, 0, 0, std::nullopt, ""},
      {"domain", Origin::loaded, 0.25, 0.5, 10, 40, ""},
      {"opening", Origin::built, 2, 0, 0, std::nullopt, "it is not cached: the disk is full"}};
  EXPECT_EQ(artefacts_json(records), parse_own(R"({
    "built": [
      {"name": "skeleton", "seconds": 1.5, "disk_bytes": 100, "memory_bytes": 400},
      {"name": "opening", "seconds": 2.0, "disk_bytes": 0, "remark": "it is not cached: the disk is full"}
    ],
    "loaded": [
      {"name": "domain", "seconds": 0.25, "waited_seconds": 0.5, "disk_bytes": 10, "memory_bytes": 40}
    ],
    "left_out": ["portals"]
  })"));
}

TEST(ArtefactsJson, HasItsListsWhereNothingWasAsked) {
  EXPECT_EQ(json_text(artefacts_json({})), R"({"built":[],"loaded":[],"left_out":[]})");
}

}  // namespace
}  // namespace lacuna
