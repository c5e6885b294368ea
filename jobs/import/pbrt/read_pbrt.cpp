#include "jobs/import/pbrt/read_pbrt.h"

#include <fmt/format.h>

#include "jobs/import/pbrt/pbrt_reader.h"
#include "jobs/import/pbrt/pbrt_version.h"

namespace lacuna {

ImportedScene read_pbrt(const std::filesystem::path& file, MissingFiles missing) {
  const auto version = pbrt::find_version(file);
  pbrt::Reader reader(file, version.value_or(pbrt::Version::v4));
  if (!version) {
    reader.context().approximated({std::make_shared<const std::string>(file.filename()), 1}, "file",
                                  "read as pbrt-v4: no statement of it shows the version");
  }
  reader.read();
  const auto& gone = reader.context().missing();
  if (!gone.empty() && missing == MissingFiles::refuse) {
    pbrt::fail(
        gone[0].place,
        fmt::format("{}: {}{}; --missing skip leaves such files out", gone[0].owner, gone[0].how,
                    gone.size() == 1 ? "" : fmt::format(" (and {} more)", gone.size() - 1)));
  }
  return reader.finish();
}

}  // namespace lacuna
