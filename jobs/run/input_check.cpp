#include "jobs/run/input_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "jobs/run/reference.h"
#include "jobs/spec/problems.h"
#include "renderer/core/scene_error.h"
#include "renderer/gltf/scene_folder.h"

namespace lacuna {

const char* const inputs_not_recorded =
    "rendered by an older version that did not record its inputs: changes of its scene, textures, "
    "environment or reference are not detected";

std::optional<std::vector<std::string>> InputCheck::changes(const JobFolder& folder) {
  const bool begun = std::filesystem::exists(folder.file("checkpoint.bin")) ||
                     folder.read_state().state == State::done;
  if (!begun) return std::vector<std::string>{};
  const auto recorded = read_inputs(folder);
  if (!recorded) return std::nullopt;
  std::string scene;
  for (const InputFile& file : *recorded) {
    if (file.role == InputRole::scene) scene = file.name;
  }
  InputList files;
  for (const InputFile& file : *recorded) files.push_back(now(file, scene));
  return changed_inputs(*recorded, files);
}

InputFile InputCheck::now(const InputFile& recorded, const std::string& scene) {
  InputFile file;
  try {
    const std::filesystem::path path = find(recorded, scene);
    const auto known = measured_.find(path);
    // The hash was computed only if the size matched.
    if (known != measured_.end() &&
        (!known->second.hash.empty() || known->second.bytes != recorded.bytes)) {
      file = known->second;
    } else {
      file = measured_[path] = measure_input(path, recorded.bytes);
    }
  } catch (const std::invalid_argument&) {
  } catch (const SceneError&) {
  }
  file.role = recorded.role;
  file.name = recorded.name;
  return file;
}

std::filesystem::path InputCheck::find(const InputFile& recorded, const std::string& scene) const {
  const auto scene_file = [&] { return scenes_.resolve(scene, scene_extensions); };
  switch (recorded.role) {
    case InputRole::scene:
      return scene_file();
    case InputRole::buffer:
    case InputRole::texture:
      return SceneFolder(scene_file()).find(recorded.name, input_text(recorded));
    case InputRole::environment:
      return scenes_.resolve(recorded.name, environment_extensions);
    case InputRole::reference:
    case InputRole::picture:
      break;
  }
  return reference_file(recorded.name, data_, scenes_);
}

void refuse_changed_inputs(const JobFolder& folder, const std::vector<std::string>& changes) {
  if (changes.empty()) return;
  constexpr std::size_t most = 5;  // named
  const std::size_t named = std::min(most, changes.size());
  throw BadJob(
      {{"",
        fmt::format(
            "the input files of {} have changed since it was rendered: {}{}; allowed: the same "
            "files, or to render it again (`lacuna render --again`)",
            folder.dir().string(),
            fmt::join(changes.begin(), changes.begin() + std::ptrdiff_t(named), "; "),
            changes.size() > named ? fmt::format("; and {} more", changes.size() - named) : "")}});
}

}  // namespace lacuna
