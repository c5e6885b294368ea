#include "jobs/import/mitsuba/read_mitsuba.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "base/json/json_cursor.h"
#include "jobs/import/mitsuba/emitters.h"
#include "jobs/import/mitsuba/scene_element.h"
#include "jobs/import/mitsuba/sensors.h"
#include "jobs/import/mitsuba/shapes.h"
#include "renderer/core/scene_error.h"

namespace lacuna {
namespace mitsuba {
namespace {

/// One note for many that say the same of the same kind of plugin.
std::vector<ImportNote> joined(std::vector<ImportNote> notes) {
  std::vector<ImportNote> out;
  std::map<std::string, std::pair<std::size_t, int>> first;
  for (ImportNote& note : notes) {
    const auto type = note.name.find_last_of('(');
    const std::string key =
        fmt::format("{} {} {}", type == std::string::npos ? note.name : note.name.substr(type),
                    note.treatment, note.how);
    const auto [found, added] = first.try_emplace(key, out.size(), 0);
    if (added) {
      out.push_back(std::move(note));
    } else {
      ++found->second.second;
    }
  }
  for (const auto& [key, at] : first) {
    if (at.second > 0) out[at.first].how += fmt::format(" (and {} more of its kind)", at.second);
  }
  return out;
}

/// Elements of the scene itself that others refer to.
bool is_referred_to(const SceneElement& e) {
  constexpr std::array<std::string_view, 11> tags{"bsdf",  "texture", "alias",     "medium",
                                                  "ref",   "rgb",     "spectrum",  "volume",
                                                  "phase", "rfilter", "subsurface"};
  return std::ranges::find(tags, e.tag) != tags.end() || (e.tag == "emitter" && is_of_shapes(e));
}

/// A further folder of files. What lies outside of the scene's is not searched.
void add_folder(ReadContext& context, const SceneElement& e) {
  std::string name = e.attribute("value");
  if (!find_within(context.folder, name)) {
    context.note(e, "left out",
                 fmt::format("{} lies outside of the folder of the scene", in_quotes(name)));
    return;
  }
  if (!name.ends_with('/')) name += '/';
  context.folders.push_back(name);
}

void read_child(ReadContext& context, const SceneElement& e, Shapes& shapes, ImportedScene& scene) {
  if (is_referred_to(e)) return;
  if (e.tag == "shape") {
    shapes.add(e);
  } else if (e.tag == "emitter") {
    add_emitter(context, e, scene);
  } else if (e.tag == "sensor") {
    add_sensor(context, e, scene);
  } else if (e.tag == "integrator") {
    read_integrator(context, e, scene);
  } else if (e.tag == "path") {
    add_folder(context, e);
  } else if (e.tag == "sampler" || e.tag == "film") {
    context.parameters(e).ignore_all();
  } else {
    e.fail(
        "is no element that is read; allowed: shape, emitter, sensor, integrator, bsdf, texture, "
        "medium, default, include, ref, alias, path");
  }
}

/// Enters the spectra in files that do not exist.
void find_lacking_files(ReadContext& context, const SceneElement& e) {
  if (e.lacks_file()) {
    context.missing_files.push_back(
        fmt::format("{}: {} does not exist", e.place, e.attribute("filename")));
  }
  for (const SceneElement& child : e.children) find_lacking_files(context, child);
}

/// Emitters of shapes that no shape refers to.
void note_unused_emitters(ReadContext& context, const SceneElement& root) {
  for (const SceneElement& e : root.children) {
    if (e.tag == "emitter" && !e.read) context.note(e, "left out", "no shape refers to it");
  }
}

ImportedScene read_root(const SceneElement& root, const std::filesystem::path& folder,
                        MissingFiles missing) {
  const SceneIds ids(root);
  ImportedScene scene;
  ReadContext context{folder, ids, scene.notes, root.attribute("version").starts_with("0.")};
  find_lacking_files(context, root);
  Textures textures(context);
  Materials materials(context, textures);
  Shapes shapes(context, textures, materials, scene);
  for (const SceneElement& child : root.children) {
    read_child(context, child, shapes, scene);
  }
  note_unused_emitters(context, root);
  if (missing == MissingFiles::refuse && !context.missing_files.empty()) {
    const std::size_t others = context.missing_files.size() - 1;
    throw SceneError(fmt::format("{}{}; --missing skip leaves such files out",
                                 context.missing_files[0],
                                 others == 0 ? "" : fmt::format(" (and {} more)", others)));
  }
  if (scene.cameras.empty()) add_default_sensor(context, root, scene);
  scene.notes = joined(std::move(scene.notes));
  return scene;
}

}  // namespace
}  // namespace mitsuba

ImportedScene read_mitsuba(const std::filesystem::path& file, MissingFiles missing) {
  const mitsuba::SceneElement root = mitsuba::read_scene_file(file);
  const auto folder = std::filesystem::canonical(file).parent_path();
  return mitsuba::read_root(root, folder, missing);
}

ImportedScene read_mitsuba_text(std::string_view xml) {
  return mitsuba::read_root(mitsuba::read_scene_text(xml, "scene.xml"), {}, MissingFiles::refuse);
}

}  // namespace lacuna
