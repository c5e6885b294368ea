#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "jobs/run/merge_shards.h"

namespace lacuna {

/// The shards in `folders`, in any order, as merge_shards() takes them. Throws BadJob with every
/// reason why they make no picture: a folder that is no shard's or is not done, two of the same
/// shard, one that is missing, and shards of another job, scene, version or other layers, by the
/// names and values of what differs; what may pass (may_pass()) where a folder cannot be read now.
/// Reads no picture.
std::vector<Shard> read_shards(const std::vector<std::filesystem::path>& folders);

/// The shards that a service has had rendered for the job of `folder`, as read_shards(): runs of
/// the sweep that accepted.json names, beside `folder`. Nothing if it names none, or the job has a
/// checkpoint of its own, from which it goes on.
std::optional<std::vector<Shard>> shards_to_merge(const JobFolder& folder);

}  // namespace lacuna
