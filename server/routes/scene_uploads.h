#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "base/storage/file_handle.h"
#include "jobs/queue/executor.h"
#include "jobs/queue/queue_settings.h"

namespace lacuna {

struct SceneUploadSettings {
  std::filesystem::path folder;                   ///< of the uploaded scenes; created if missing
  std::vector<std::filesystem::path> older = {};  ///< scenes roots that precede `folder`
  std::filesystem::path renderer;                 ///< the `lacuna` command, which checks them
  ChildLimits limits;                             ///< of the check
  std::chrono::milliseconds time{120'000};        ///< that a check may take
};

/// "NAME.glb" or "NAME.zip": a letter or digit, then at most 79 letters, digits, '.', '_' or '-',
/// never "..".
bool is_upload_name(std::string_view name);
inline constexpr const char* upload_name_rule =
    "allowed: a letter or digit, then up to 79 letters, digits, '.', '_' or '-' without \"..\", "
    "and \".glb\" or \".zip\" (letters are a to z and A to Z)";

/// Scenes uploaded over the network, each a GLB or the archive of a folder (scene_archive.h): a
/// child process checks each before it gets its name; it never replaces another. A scene may refer
/// to no file but those of its archive: during the check it lies alone in a folder, with an
/// unguessable name.
class SceneUploads {
 public:
  /// Creates the folder, and removes unfinished uploads of an earlier service. Throws
  /// std::system_error.
  explicit SceneUploads(SceneUploadSettings settings);

  /// A file for the body, removed with the object.
  class Draft {
   public:
    explicit Draft(const std::filesystem::path& folder);  ///< throws std::system_error
    Draft(Draft&& o) noexcept = default;
    Draft& operator=(Draft&&) = delete;
    ~Draft();
    int fd() const { return handle_.get(); }  ///< for writing the body, from the start
    const std::filesystem::path& file() const { return file_; }
    void finish();  ///< call after writing: syncs and closes; throws std::system_error

   private:
    std::filesystem::path own_folder_, file_;
    FileHandle handle_;
  };
  Draft begin() const { return Draft(settings_.folder); }

  enum class Outcome {
    created,   ///< stored under its name
    same,      ///< the same bytes were stored already
    conflict,  ///< another scene has the name, here or in a preceding root, which would hide it
    refused,   ///< not a valid scene; see `reason`
    busy,  ///< it cannot be checked now: another check runs, the service stops, or its files cannot
           ///< be used; see `reason`
  };
  struct Result {
    Outcome outcome;
    std::uint64_t bytes = 0;  ///< of the body
    std::string scene = {};   ///< if it is stored: its name for jobs
    std::string reason = {};  ///< one line, at most 4 KiB
  };
  /// Checks a draft and gives it its name. Blocks during the check; called from several threads.
  /// Throws std::invalid_argument if is_upload_name() is false, std::system_error if the scene
  /// cannot be stored or the check cannot be started.
  Result publish(Draft draft, const std::string& name);

  /// Ends a running check; later ones are `busy`.
  void stop() const { stop_.request(); }

 private:
  struct Upload;
  Result checked(const Upload& upload) const;
  Result check(const Upload& upload) const;

  const SceneUploadSettings settings_;
  StopSignal stop_;
  std::mutex checking_;
};

}  // namespace lacuna
