#include "jobs/run/artefacts_json.h"

#include <nlohmann/json.hpp>

namespace lacuna {
namespace {

using Json = nlohmann::ordered_json;

Json made(const ArtefactRecord& r) {
  Json j{{"name", r.type}, {"seconds", r.seconds}};
  if (r.waited_seconds > 0) j["waited_seconds"] = r.waited_seconds;
  j["disk_bytes"] = r.disk_bytes;
  if (r.content_bytes) j["memory_bytes"] = *r.content_bytes;
  if (!r.remark.empty()) j["remark"] = r.remark;
  return j;
}

}  // namespace

Json artefacts_json(const std::vector<ArtefactRecord>& records) {
  Json j{{"built", Json::array()}, {"loaded", Json::array()}, {"left_out", Json::array()}};
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
