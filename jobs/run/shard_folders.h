#pragma once

#include <filesystem>
#include <vector>

#include "jobs/run/merge_shards.h"

namespace lacuna {

/// The shards in `folders`, in any order, as merge_shards() takes them. Throws BadJob with every
/// reason why they make no picture: a folder that is no shard's or is not done, two of the same
/// shard, one that is missing, and shards of another job, scene, version or other layers, by the
/// names and values of what differs. Reads no picture.
std::vector<Shard> read_shards(const std::vector<std::filesystem::path>& folders);

}  // namespace lacuna
