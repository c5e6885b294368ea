#include "jobs/run/artefacts_json.h"

#include <nlohmann/json.hpp>

namespace lacuna {
namespace {

OrderedJson made(const ArtefactRecord& r) {
  OrderedJson j{{"name", r.type}, {"seconds", r.seconds}};
  if (r.waited_seconds > 0) j["waited_seconds"] = r.waited_seconds;
  j["disk_bytes"] = r.disk_bytes;
  if (r.content_bytes) j["memory_bytes"] = *r.content_bytes;
  if (!r.remark.empty()) j["remark"] = r.remark;
  return j;
}

}  // namespace

OrderedJson artefacts_json(const std::vector<ArtefactRecord>& records) {
  OrderedJson j{{"built", OrderedJson::array()},
                {"loaded", OrderedJson::array()},
                {"left_out", OrderedJson::array()}};
  for (const ArtefactRecord& r : records) {
    switch (r.origin) {
      case ArtefactRecord::Origin::built:
        j["built"].push_back(made(r));
        break;
      case ArtefactRecord::Origin::loaded:
        j["loaded"].push_back(made(r));
        break;
      case ArtefactRecord::Origin::not_needed:
        j["left_out"].push_back(r.type);
        break;
    }
  }
  return j;
}

}  // namespace lacuna
