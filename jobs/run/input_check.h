#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "jobs/store/inputs.h"

namespace lacuna {

/// Compares what jobs were made from with the files as they are now. Each file is read once in the
/// life of the object, and only if its size is still the recorded one.
class InputCheck {
 public:
  InputCheck(DataRoot data, ScenesRoots scenes)
      : data_(std::move(data)), scenes_(std::move(scenes)) {}

  /// What has changed since the job was rendered (changed_inputs()), if it is done or has a
  /// checkpoint; nothing if its inputs are not recorded. Throws InputUnreadable; and what
  /// JobFolder::read_state() and read_inputs() throw.
  std::optional<std::vector<std::string>> changes(const JobFolder& folder);

 private:
  InputFile now(const InputFile& recorded, const std::string& scene);
  std::filesystem::path find(const InputFile& recorded, const std::string& scene) const;

  DataRoot data_;
  ScenesRoots scenes_;
  std::map<std::filesystem::path, InputFile> measured_;
};

/// Throws BadJob if there are any `changes`: the job's folder was made from other files than there
/// are now.
void refuse_changed_inputs(const JobFolder& folder, const std::vector<std::string>& changes);

/// The warning about a folder of an older build.
extern const char* const inputs_not_recorded;

}  // namespace lacuna
