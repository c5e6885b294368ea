#include "jobs/import/pbrt/pbrt_context.h"

#include <fmt/format.h>

#include <algorithm>

namespace lacuna::pbrt {

void Context::note(const Place& place, const std::string& name, const std::string& treatment,
                   const std::string& how) {
  // The same remark about things of the same kind (`Shape "sphere"`) is one note.
  const std::string key = fmt::format("{}\n{}\n{}", name, treatment, how);
  const auto [found, is_new] = known_.emplace(key, notes_.size());
  if (is_new) {
    notes_.push_back({{place.text(), name, treatment, how}, 0});
  } else {
    ++notes_[found->second].more;
  }
}

std::vector<ImportNote> Context::notes() const {
  std::vector<ImportNote> out;
  for (const Counted& c : notes_) {
    out.push_back(c.note);
    if (c.more > 0) out.back().how += fmt::format(" (and {} more)", c.more);
  }
  return out;
}

void Context::note_unused(const Parameters& parameters) {
  for (const Parameter* p : parameters.unused()) {
    left_out(p->place, parameters.owner(), fmt::format("parameter \"{} {}\"", p->type, p->name));
  }
}

std::filesystem::path Context::resolve(const std::string& name, const Place& place) const {
  const std::filesystem::path path(name);
  const auto inside =
      (folder / path).lexically_normal().lexically_relative(folder.lexically_normal());
  const bool leaves = path.is_absolute() || inside.empty() || *inside.begin() == "..";
  if (name.empty() || leaves) {
    fail(place,
         fmt::format("file \"{}\"; allowed: files within the folder of the scene file", name));
  }
  std::error_code none;
  const auto real = std::filesystem::weakly_canonical(folder / path, none);
  const auto root = std::filesystem::weakly_canonical(folder.empty() ? "." : folder, none);
  const auto below = real.lexically_relative(root);
  if (below.empty() || *below.begin() == "..") {
    fail(place, fmt::format("file \"{}\" is a link out of the folder of the scene file", name));
  }
  return folder / path;
}

std::optional<std::filesystem::path> Context::find_file(const std::string& name, const Place& place,
                                                        const std::string& owner) {
  const auto path = resolve(name, place);
  std::error_code none;
  if (std::filesystem::is_regular_file(path, none)) return path;
  missing_.push_back({place, owner, name});
  left_out(place, owner, fmt::format("file \"{}\" does not exist", name));
  return std::nullopt;
}

void Context::require_materials() const {
  for (const auto& entry : expected_) {
    if (entry->defined) continue;
    fail(entry->first_use, fmt::format("material \"{}\" is not defined", entry->name));
  }
}

}  // namespace lacuna::pbrt
