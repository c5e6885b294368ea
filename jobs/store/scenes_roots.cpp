#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <exception>
#include <set>
#include <stdexcept>

#include "base/storage/file_handle.h"
#include "base/storage/input_file.h"
#include "base/storage/passing_error.h"
#include "jobs/spec/nearest.h"
#include "jobs/store/job_folder.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;
using Extensions = std::vector<std::string_view>;

constexpr int max_list_depth = 4;
constexpr int max_list_entries = 10000;

/// The folder of scenes in the source tree of this build.
fs::path source_scenes() { return fs::path(__FILE__).parent_path().parent_path() / "scenes"; }

/// The folder of scenes installed with this program; it may be missing.
fs::path installed_scenes() {
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  return program.parent_path().parent_path() / "share/lacuna/scenes";
}

std::vector<std::string_view> parts_of(std::string_view name) {
  std::vector<std::string_view> parts;
  for (;;) {
    const auto slash = name.find('/');
    parts.push_back(name.substr(0, slash));
    if (slash == std::string_view::npos) return parts;
    name.remove_prefix(slash + 1);
  }
}

bool has_extension(std::string_view name, const Extensions& extensions) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; };
  return std::any_of(extensions.begin(), extensions.end(), [&](std::string_view e) {
    return name.size() > e.size() &&
           std::equal(e.begin(), e.end(), name.end() - std::ptrdiff_t(e.size()),
                      [&](char a, char b) { return lower(a) == lower(b); });
  });
}

/// Why a name is refused before any lookup; empty: it is not.
std::string fault_of(std::string_view name, const Extensions& extensions) {
  if (name.empty()) return "it is empty";
  if (name.front() == '/') return "it is absolute; allowed: a name below a scenes root";
  for (const char c : name) {
    if (c == '\\') return "it has a backslash; parts are separated by '/'";
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) return "it has a control character";
  }
  for (const std::string_view part : parts_of(name)) {
    if (part.empty()) return "it has an empty part";
    if (part == "." || part == "..") return "it has a part \".\" or \"..\"";
  }
  if (!has_extension(name, extensions)) {
    return fmt::format("it does not end in {}", fmt::join(extensions, " or "));
  }
  return {};
}

/// The name, escaped for messages.
std::string shown(std::string_view name) {
  constexpr std::size_t longest = 200;
  std::string text(name.substr(0, longest));
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return '"' + text + (name.size() > longest ? "...\"" : "\"");
}

/// Opens part after part without following links. Returns 0 for a regular file, else an errno.
int walk(const fs::path& root, std::string_view name) {
  FileHandle at(::open(root.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
  struct stat info {};
  for (const std::string_view part : parts_of(name)) {
    if (!at) return errno;
    const std::string text(part);
    at = FileHandle(::openat(at.get(), text.c_str(), O_PATH | O_NOFOLLOW | O_CLOEXEC));
    if (!at || ::fstat(at.get(), &info) != 0) return errno;
    if (S_ISLNK(info.st_mode)) return ELOOP;
  }
  if (S_ISREG(info.st_mode)) return 0;
  return S_ISDIR(info.st_mode) ? EISDIR : EINVAL;
}

/// Names below one root, without hidden ones and without following links.
void list_root(const fs::path& root, const Extensions& extensions, std::set<std::string>& names) {
  std::error_code error;  // an unreadable root or folder has no names
  fs::recursive_directory_iterator it(root, fs::directory_options::skip_permission_denied, error);
  for (int entries = 0; !error && it != fs::end(it) && entries < max_list_entries; ++entries) {
    const auto status = it->symlink_status(error);
    const bool hidden = it->path().filename().string().starts_with('.');
    if (fs::is_directory(status) && (hidden || it.depth() + 1 >= max_list_depth)) {
      it.disable_recursion_pending();
    }
    const std::string name = it->path().lexically_relative(root).generic_string();
    if (!hidden && fs::is_regular_file(status) && fault_of(name, extensions).empty()) {
      names.insert(name);
    }
    it.increment(error);
  }
}

std::vector<std::string> names_below(const std::vector<fs::path>& roots,
                                     const Extensions& extensions) {
  std::set<std::string> names;
  for (const fs::path& root : roots) list_root(root, extensions, names);
  return {names.begin(), names.end()};
}

std::string available(std::string_view wanted, const std::vector<std::string>& names,
                      const Extensions& extensions) {
  constexpr std::size_t most = 20;
  const std::string kinds = fmt::format("{}", fmt::join(extensions, ", "));
  if (names.empty()) return fmt::format("; there is no {} file below the scenes roots", kinds);
  std::string text = nearest_hint(wanted, {names.begin(), names.end()});
  text += fmt::format("; available ({}): ", kinds);
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i) {
    text += (i == 0 ? "" : ", ") + names[i];
  }
  if (names.size() > most) text += fmt::format(" and {} more", names.size() - most);
  return text;
}

}  // namespace

ScenesRoots ScenesRoots::from_environment() {
  std::vector<fs::path> roots;
  const char* named = std::getenv("LACUNA_SCENES");
  if (named != nullptr && *named != '\0') {
    std::string_view rest = named;
    while (!rest.empty()) {
      const auto colon = std::min(rest.find(':'), rest.size());
      if (colon > 0) roots.push_back(fs::absolute(rest.substr(0, colon)));
      rest.remove_prefix(std::min(colon + 1, rest.size()));
    }
    return ScenesRoots(std::move(roots));
  }
  roots.push_back(fs::absolute("jobs/scenes"));
  std::error_code ignored;  // false if either is missing
  for (const fs::path& own : {installed_scenes(), source_scenes()}) {
    if (!fs::is_directory(own, ignored) || fs::equivalent(roots.front(), own, ignored)) continue;
    if (!fs::is_directory(roots.front(), ignored)) roots.clear();
    roots.push_back(own);
    break;
  }
  return ScenesRoots(std::move(roots));
}

fs::path ScenesRoots::resolve(std::string_view name, const Extensions& extensions) const {
  std::string fault = fault_of(name, extensions);
  if (fault.empty()) {
    int worst = ENOENT;
    std::exception_ptr away;  // a root that is missing or empty, such as an unmounted one
    for (const fs::path& root : roots_) {
      const int error = walk(root, name);
      if (error == 0) return root / name;
      try {
        throw_if_it_may_pass(error, root / name, root);
      } catch (const InputUnreadable&) {
        // An unreadable file is not missing: do not fall back to a later root's file.
        if (error != ENOENT) throw;
        if (!away) away = std::current_exception();
      }
      if (error != ENOENT && error != ENOTDIR) worst = error;
    }
    if (away && worst == ENOENT) std::rethrow_exception(away);
    fault = worst == ENOENT  ? "it does not exist"
            : worst == ELOOP ? "a part of it is a symbolic link; links are not followed"
                             : "it is not a readable regular file";
  }
  throw std::invalid_argument(
      fmt::format("{} cannot be used: {}{}", shown(name), fault,
                  available(name, names_below(roots_, extensions), extensions)));
}

std::vector<std::string> ScenesRoots::list() const { return names_below(roots_, scene_extensions); }

}  // namespace lacuna
