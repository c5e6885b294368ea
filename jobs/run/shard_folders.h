#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "jobs/run/merge_shards.h"

namespace lacuna {

/// The shards in `folders`, in any order, for merge_shards(). Throws BadJob with every reason why
/// they cannot be merged: a folder that is not a shard or not done, a duplicate or missing shard,
/// and shards of another job, scene, version or other layers, with the names and values that
/// differ; a transient error (may_pass()) if a folder cannot be read now. Reads no picture.
std::vector<Shard> read_shards(const std::vector<std::filesystem::path>& folders);

/// The shards that a service has rendered for the job of `folder`, as read_shards(): runs of the
/// sweep that accepted.json names, beside `folder`. None if it names no sweep, or if the job has
/// its own checkpoint, from which it continues.
std::optional<std::vector<Shard>> shards_to_merge(const JobFolder& folder);

}  // namespace lacuna
