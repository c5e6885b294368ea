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
  std::filesystem::path folder;  ///< of the uploaded scenes; made if it is not there
  std::vector<std::filesystem::path> older =
      {};                                   ///< scenes roots that a name is looked up in before
  std::filesystem::path renderer;           ///< the `lacuna` command, which checks them
  ChildLimits limits;                       ///< of the check
  std::chrono::milliseconds time{120'000};  ///< that a check may take
};

/// "NAME.glb": a letter or digit, then at most 79 letters, digits, '.', '_' or '-', never "..".
bool is_upload_name(std::string_view name);
inline constexpr const char* upload_name_rule =
    "allowed: a letter or digit, then up to 79 letters, digits, '.', '_' or '-' without \"..\", "
    "and "
    "\".glb\" (letters are a to z and A to Z)";

/// Scenes that come over the network: each is checked by a child process before it gets its name,
/// and never replaces another. A scene may name no other file: while it is checked it lies alone in
/// a folder, under a name that nobody can guess.
class SceneUploads {
 public:
  /// Makes the folder, and removes what an earlier service left unfinished. Throws
  /// std::system_error.
  explicit SceneUploads(SceneUploadSettings settings);

  /// A place for the body; gone with the object.
  class Draft {
   public:
    explicit Draft(const std::filesystem::path& folder);  ///< throws std::system_error
    Draft(Draft&& o) noexcept = default;
    Draft& operator=(Draft&&) = delete;
    ~Draft();
    int fd() const { return handle_.get(); }  ///< to write the body to, from its start
    const std::filesystem::path& file() const { return file_; }
    void finish();  ///< all is written: syncs and closes; throws std::system_error

   private:
    std::filesystem::path own_folder_, file_;
    FileHandle handle_;
  };
  Draft begin() const { return Draft(settings_.folder); }

  enum class Outcome {
    created,   ///< it is there under its name now
    same,      ///< the very same bytes were there already
    conflict,  ///< another scene of that name is there, or in an older root, which would hide it
    refused,   ///< it is not a scene that can be rendered; `reason` says why
    busy,      ///< it cannot be checked now, as another one is, or the service ends, or its files
               ///< cannot be used; `reason` says why
  };
  struct Result {
    Outcome outcome;
    std::uint64_t bytes = 0;  ///< of the scene
    std::string reason = {};  ///< one line, at most 4 KiB
  };
  /// Checks a draft and gives it its name. Takes as long as the check; called from several threads.
  /// Throws std::invalid_argument if is_upload_name() does not hold, std::system_error if the
  /// scene cannot be stored or the check not be started.
  Result publish(Draft draft, const std::string& name);

  /// Ends a check that is under way; from then on all are `busy`.
  void stop() const { stop_.request(); }

 private:
  Result check(const std::filesystem::path& file, std::uint64_t bytes) const;

  const SceneUploadSettings settings_;
  StopSignal stop_;
  std::mutex checking_;
};

}  // namespace lacuna
