#include "server/routes/scene_uploads.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <random>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "jobs/queue/child_process.h"
#include "jobs/spec/byte_size.h"
#include "jobs/store/exit_code.h"
#include "server/routes/scene_archive.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view draft_prefix = ".upload-";
constexpr std::size_t longest_reason = 4096;
constexpr std::uint64_t longest_output = 1 << 20;

bool is_glb(const fs::path& file) {
  std::array<char, 4> magic{};
  std::ifstream(file, std::ios::binary).read(magic.data(), magic.size());
  return std::string_view(magic.data(), magic.size()) == "glTF";
}

/// Whether two regular files have the same bytes; does not follow a link at `there`.
bool same_bytes(const fs::path& there, const fs::path& draft) {
  if (!fs::is_regular_file(fs::symlink_status(there))) return false;
  if (fs::file_size(there) != fs::file_size(draft)) return false;
  std::ifstream a(there, std::ios::binary), b(draft, std::ios::binary);
  std::vector<char> from_a(1 << 16), from_b(1 << 16);
  do {
    a.read(from_a.data(), static_cast<std::streamsize>(from_a.size()));
    b.read(from_b.data(), static_cast<std::streamsize>(from_b.size()));
    if (a.gcount() != b.gcount() ||
        !std::equal(from_a.begin(), from_a.begin() + a.gcount(), from_b.begin())) {
      return false;
    }
  } while (a && b);
  return a.eof() && b.eof();
}

/// Whether two folders have the same files; `there` may have anything in it.
bool same_folders(const fs::path& there, const fs::path& draft) {
  if (!fs::is_directory(fs::symlink_status(there))) return false;
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(draft)) {
    if (!entry.is_regular_file()) continue;
    ++files;
    if (!same_bytes(there / entry.path().lexically_relative(draft), entry.path())) return false;
  }
  const fs::recursive_directory_iterator all(there);
  return std::count_if(begin(all), end(all), [](const fs::directory_entry& e) {
           return !fs::is_directory(e.symlink_status());
         }) == static_cast<std::ptrdiff_t>(files);
}

/// The last line of a child's output, which contains the reason.
std::string last_line(std::string text) {
  text.erase(0, text.size() - std::min(text.size(), longest_reason));
  while (!text.empty() && text.back() == '\n') text.pop_back();
  text.erase(0, text.rfind('\n') + 1);  // npos + 1: there is only one
  return text;
}

/// `text` without the prefix "lacuna: " and the draft's path.
std::string tidy(std::string text, const fs::path& draft) {
  for (const std::string& noise : {std::string("lacuna: "), draft.string() + ": "}) {
    if (text.starts_with(noise)) text.erase(0, noise.size());
  }
  return text;
}

}  // namespace

bool is_upload_name(std::string_view name) {
  constexpr std::size_t longest = 80;
  if (!name.ends_with(".glb") && !name.ends_with(".zip")) return false;
  if (name.find("..") != std::string_view::npos) return false;
  const std::string_view stem = name.substr(0, name.size() - 4);
  const auto plain = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
  };
  const auto allowed = [&](char c) { return plain(c) || c == '.' || c == '_' || c == '-'; };
  return !stem.empty() && stem.size() <= longest && plain(stem.front()) &&
         std::all_of(stem.begin(), stem.end(), allowed);
}

SceneUploads::Draft::Draft(const fs::path& folder) {
  std::string name = (folder / draft_prefix).string() + "XXXXXX";
  if (::mkdtemp(name.data()) == nullptr) throw_file_error(errno, "create a folder in", folder);
  own_folder_ = name;
  std::random_device random;
  file_ = own_folder_ / fmt::format("{:08x}{:08x}.glb", random(), random());
  handle_ = FileHandle(::open(file_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644));
  if (handle_) return;
  const int error = errno;
  ::rmdir(own_folder_.c_str());
  throw_file_error(error, "create", file_);
}

SceneUploads::Draft::~Draft() {
  if (own_folder_.empty()) return;  // moved away
  std::error_code ignored;          // the rest is removed at the next start
  fs::remove_all(own_folder_, ignored);
}

void SceneUploads::Draft::finish() {
  if (!handle_) return;
  if (::fsync(handle_.get()) != 0) throw_file_error(errno, "sync", file_);
  if (!handle_.close()) throw_file_error(errno, "write", file_);
}

SceneUploads::SceneUploads(SceneUploadSettings settings) : settings_(std::move(settings)) {
  fs::create_directories(settings_.folder);
  // An empty root would count as unmounted (ScenesRoots::resolve).
  std::ofstream(settings_.folder / ".uploads");
  std::vector<fs::path> left;
  for (const auto& entry : fs::directory_iterator(settings_.folder)) {
    const bool folder = fs::is_directory(entry.symlink_status());
    if (folder && entry.path().filename().string().starts_with(draft_prefix)) {
      left.push_back(entry.path());
    }
  }
  std::error_code ignored;  // it only takes space
  for (const fs::path& folder : left) fs::remove_all(folder, ignored);
}

/// What is uploaded: a file, or the folder of an archive.
struct SceneUploads::Upload {
  Upload(const fs::path& draft, std::string file_name)
      : name(std::move(file_name)),
        archived(name.ends_with(".zip")),
        bytes(fs::file_size(draft)),
        content(archived ? fs::path(draft).replace_extension() : draft),
        scene(archived ? content / archived_scene : content) {
    if (archived) name.resize(name.size() - 4);
  }

  bool same_as(const fs::path& there) const {
    return archived ? same_folders(there, content) : same_bytes(there, content);
  }
  Result stored(Outcome outcome) const {
    return {outcome, bytes, archived ? name + "/" + archived_scene : name};
  }
  Result not_stored(Outcome outcome, const std::string& reason) const {
    return {outcome, bytes, "", reason};
  }
  /// Unlike a rename of files, neither replaces anything. False: something has that name.
  bool move_to(const fs::path& target) const {
    const int failed = archived ? ::renameat2(AT_FDCWD, content.c_str(), AT_FDCWD, target.c_str(),
                                              RENAME_NOREPLACE)
                                : ::link(content.c_str(), target.c_str());
    if (failed != 0 && errno != EEXIST) throw_file_error(errno, "create", target);
    return failed == 0;
  }

  std::string name;  ///< of the file or folder, in a scenes root
  bool archived;
  std::uint64_t bytes;      ///< of the body
  fs::path content, scene;  ///< before it has its name
};

SceneUploads::Result SceneUploads::publish(Draft draft, const std::string& name) {
  if (!is_upload_name(name)) {
    throw std::invalid_argument(fmt::format("found \"{}\"; {}", name, upload_name_rule));
  }
  draft.finish();
  const Upload upload(draft.file(), name);
  const std::unique_lock lock(checking_, std::try_to_lock);
  if (!lock) return upload.not_stored(Outcome::busy, "Another scene is being checked.");
  if (stop_.is_requested()) {
    return upload.not_stored(Outcome::busy, "The service is shutting down.");
  }
  if (upload.archived) {
    try {
      unpack_scene(draft.file(), upload.content);
    } catch (const BadArchive& error) {
      return upload.not_stored(Outcome::refused, error.what());
    }
  }
  const auto known = [&](const fs::path& there) {
    return upload.stored(upload.same_as(there) ? Outcome::same : Outcome::conflict);
  };
  // A job that names the scene would get the older root's.
  for (const fs::path& root : settings_.older) {
    if (fs::exists(fs::symlink_status(root / upload.name))) return known(root / upload.name);
  }
  const fs::path target = settings_.folder / upload.name;
  if (fs::exists(fs::symlink_status(target))) return known(target);
  const Result result = checked(upload);
  if (result.outcome != Outcome::created) return result;
  if (!upload.move_to(target)) return known(target);
  try {
    sync_folder(settings_.folder);
  } catch (const std::system_error&) {  // a failed upload must not remain
    std::error_code failed;
    if (fs::remove_all(target, failed) > 0 && !failed) throw;
  }
  return result;
}

SceneUploads::Result SceneUploads::checked(const Upload& upload) const {
  if (!is_glb(upload.scene)) {
    return upload.not_stored(Outcome::refused, "it is not a GLB: it does not begin with \"glTF\"");
  }
  try {
    return check(upload);
  } catch (const std::system_error& error) {
    return upload.not_stored(Outcome::busy, error.code().message());
  }
}

/// Returns `created` if the scene is valid.
SceneUploads::Result SceneUploads::check(const Upload& upload) const {
  ChildLimits limits = settings_.limits;
  limits.file_bytes = longest_output;
  const Command command{
      .arguments = {settings_.renderer.string(), "check", "--scene", upload.scene.string()},
      .environment = own_environment(),
      .directory = settings_.folder,
      .limits = limits};
  const BoundedRun run = run_bounded(command, stop_.fd(), settings_.time);
  if (!run.in_time) {
    if (stop_.is_requested()) {
      return upload.not_stored(Outcome::busy, "The service is shutting down.");
    }
    return upload.not_stored(Outcome::refused,
                             fmt::format("it could not be checked within {} s",
                                         static_cast<double>(settings_.time.count()) / 1000));
  }
  const Ending& end = run.end;
  const bool exited = end.kind == Ending::Kind::exited;
  if (exited && end.code == exit_done) return upload.stored(Outcome::created);
  if (exited && end.code == exit_memory) {
    return upload.not_stored(
        Outcome::refused,
        fmt::format("loading it takes more memory than allowed{}",
                    limits.memory_bytes > 0 ? ", " + byte_size_text(limits.memory_bytes) : ""));
  }
  const std::string said = tidy(last_line(run.output + run.errors), upload.scene);
  const bool for_now = never_began(end) || (exited && end.code == exit_interrupted) ||
                       !why_it_cannot_begin(command, end, stop_).empty();
  if (for_now) return upload.not_stored(Outcome::busy, said.empty() ? end.reason : said);
  const bool told = exited && end.code == exit_asset && !said.empty();
  return upload.not_stored(Outcome::refused, told ? said : "its check failed: " + end.reason);
}

}  // namespace lacuna
