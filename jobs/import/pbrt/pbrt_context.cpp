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

namespace {

/// Whether a name, as it is written, leads out of the folder that it is relative to.
bool leads_out(const std::filesystem::path& folder, const std::filesystem::path& path) {
  const auto inside =
      (folder / path).lexically_normal().lexically_relative(folder.lexically_normal());
  return path.is_absolute() || inside.empty() || *inside.begin() == "..";
}

}  // namespace

std::filesystem::path Context::resolve(const std::string& name, const Place& place) const {
  const std::filesystem::path path(name);
  if (name.empty() || leads_out(folder, path)) {
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
  const bool outside = !name.empty() && leads_out(folder, name);
  std::error_code none;
  if (!outside) {
    const auto path = resolve(name, place);
    if (std::filesystem::is_regular_file(path, none)) return path;
  }
  const std::string how =
      fmt::format("file \"{}\" {}", name,
                  outside ? "lies outside of the folder of the scene file" : "does not exist");
  missing_.push_back({place, owner, how});
  left_out(place, owner, how);
  return std::nullopt;
}

void Context::require_materials() const {
  for (const auto& entry : expected_) {
    if (entry->defined) continue;
    fail(entry->first_use, fmt::format("material \"{}\" is not defined", entry->name));
  }
}

}  // namespace lacuna::pbrt
