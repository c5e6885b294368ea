#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "jobs/store/inputs.h"

namespace lacuna {

/// Compares the recorded inputs of jobs with the present files. Each file is read once in the life
/// of the object, and only if it has the recorded size.
class InputCheck {
 public:
  InputCheck(DataRoot data, ScenesRoots scenes)
      : data_(std::move(data)), scenes_(std::move(scenes)) {}

  /// The changes since the job was rendered (changed_inputs()), if it is done or has a checkpoint;
  /// none if its inputs are not recorded. Throws InputUnreadable and the exceptions of
  /// JobFolder::read_state() and read_inputs().
  std::optional<std::vector<std::string>> changes(const JobFolder& folder);
  /// The recorded file as it is now: without size and hash if it is missing or not of its type.
  InputFile now(const InputFile& recorded, const std::string& scene);
  /// The path from which a job of the scene `scene` reads it. Throws SceneError,
  /// std::invalid_argument.
  std::filesystem::path find(const InputFile& recorded, const std::string& scene) const;

 private:
  DataRoot data_;
  ScenesRoots scenes_;
  std::map<std::filesystem::path, InputFile> measured_;
};

/// Throws BadJob if there are any `changes` of the files that the job's folder was made from.
void refuse_changed_inputs(const JobFolder& folder, const std::vector<std::string>& changes);

/// The warning about a folder of an older build.
extern const char* const inputs_not_recorded;

}  // namespace lacuna
