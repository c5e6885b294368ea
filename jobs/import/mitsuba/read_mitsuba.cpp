#include "jobs/import/mitsuba/read_mitsuba.h"

#include <fmt/format.h>

#include <map>

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

void read_child(ReadContext& context, const SceneElement& e, Shapes& shapes, ImportedScene& scene) {
  if (e.tag == "shape") {
    shapes.add(e);
  } else if (e.tag == "emitter") {
    add_emitter(context, e, scene);
  } else if (e.tag == "sensor") {
    add_sensor(context, e, scene);
  } else if (e.tag == "integrator") {
    read_integrator(context, e, scene);
  } else if (e.tag == "path" || e.tag == "sampler" || e.tag == "film") {
    context.parameters(e).ignore_all();
    if (e.tag == "path") e.fail("is a further folder; allowed: files in the folder of the scene");
  } else if (e.tag != "bsdf" && e.tag != "texture" && e.tag != "alias" && e.tag != "medium" &&
             e.tag != "ref" && e.tag != "spectrum" && e.tag != "rgb") {
    e.fail(
        "is no element that is read; allowed: shape, emitter, sensor, integrator, bsdf, texture, "
        "medium, default, include, ref, alias");
  }
}

ImportedScene read_root(const SceneElement& root, const std::filesystem::path& folder,
                        MissingFiles missing) {
  const SceneIds ids(root);
  ImportedScene scene;
  ReadContext context{folder, ids, scene.notes, root.attribute("version").starts_with("0.")};
  Textures textures(context);
  Materials materials(context, textures);
  Shapes shapes(context, textures, materials, scene);
  for (const SceneElement& child : root.children) {
    read_child(context, child, shapes, scene);
  }
  if (missing == MissingFiles::refuse && !context.missing_files.empty()) {
    const std::size_t others = context.missing_files.size() - 1;
    throw SceneError(fmt::format("{} does not exist{}; --missing skip leaves missing files out",
                                 context.missing_files[0],
                                 others == 0 ? "" : fmt::format(", nor do {} others", others)));
  }
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
