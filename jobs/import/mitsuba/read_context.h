#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "jobs/import/imported_scene.h"
#include "jobs/import/mitsuba/parameters.h"

namespace lacuna::mitsuba {

/// What all parts of the reading share.
struct ReadContext {
  const std::filesystem::path& folder;  ///< of the scene; empty: none
  const SceneIds& ids;
  std::vector<ImportNote>& notes;
  bool reads_mtl = false;                    ///< Mitsuba 0.6 does, later ones do not
  std::vector<std::string> folders{""};      ///< where files are looked for, within `folder`
  std::vector<std::string> missing_files{};  ///< place, name and reason of each

  Parameters parameters(const SceneElement& element) const { return {element, ids}; }
  void note(const SceneElement& at, std::string treatment, std::string how) const {
    notes.push_back({at.place, at.label(), std::move(treatment), std::move(how)});
  }
  /// A file that `at` names; none, and an entry in missing_files, if the folder has no such file.
  std::optional<std::filesystem::path> file(const SceneElement& at, const std::string& name);
};

}  // namespace lacuna::mitsuba
