#include "server/routes/named_files.h"

#include <fmt/format.h>

#include <stdexcept>

#include "base/storage/passing_error.h"
#include "server/http/message.h"

namespace lacuna {

std::vector<Problem> NamedFiles::missing(const JobSpec& spec) {
  std::vector<Problem> problems;
  const auto check = [&](const std::string& name, const std::vector<std::string_view>& extensions,
                         const char* pointer) {
    const std::string& why = look_up(name, extensions);
    if (!why.empty()) problems.push_back({pointer, why});
  };
  check(spec.scene, scene_extensions, "/scene");
  if (spec.environment) check(spec.environment->file, environment_extensions, "/environment/file");
  return problems;
}

/// The error of a name; empty: none.
const std::string& NamedFiles::look_up(const std::string& name,
                                       const std::vector<std::string_view>& extensions) {
  // One name may be looked up as a scene and as an image.
  const auto [found, fresh] = seen_.try_emplace(name + '\0' + std::string(extensions.front()));
  if (!fresh) return found->second;
  try {
    scenes_.resolve(name, extensions);
  } catch (const std::invalid_argument& error) {
    found->second = error.what();
  } catch (const InputUnreadable& error) {
    seen_.erase(found);
    throw HttpError(503, fmt::format("The file \"{}\" cannot be looked up at present: {}.", name,
                                     error.code() == std::errc::no_such_file_or_directory
                                         ? "a folder of scenes is missing or empty"
                                         : error.code().message()))
        .with("Retry-After", "1");
  }
  return found->second;
}

}  // namespace lacuna
