#include "server/routes/scene_archive.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zip.h>

#include <algorithm>
#include <cerrno>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/storage/file_handle.h"
#include "jobs/spec/byte_size.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;

using Zip = std::unique_ptr<zip_t, decltype(&zip_discard)>;
using ZipFile = std::unique_ptr<zip_file_t, decltype(&zip_fclose)>;

constexpr std::size_t longest_name = 255;  // of a file or folder, bytes
constexpr std::ptrdiff_t deepest = 8;      // folders around a file

struct ArchiveFile {
  std::uint64_t index;
  std::string name;
  std::uint64_t bytes;
};

Zip open_archive(const fs::path& archive) {
  int error = 0;
  Zip zip(zip_open(archive.c_str(), ZIP_RDONLY | ZIP_CHECKCONS, &error), &zip_discard);
  if (zip) return zip;
  zip_error_t text;
  zip_error_init_with_code(&text, error);
  const std::string reason = zip_error_strerror(&text);
  zip_error_fini(&text);
  throw BadArchive("it is not a ZIP archive: " + reason);
}

bool is_of_macos(std::string_view name) {
  const std::string_view file = name.substr(name.rfind('/') + 1);
  return name.starts_with("__MACOSX/") || file == ".DS_Store";
}

/// Why no file may get this name; empty: it may.
std::string fault_of_name(std::string_view name) {
  if (std::count(name.begin(), name.end(), '/') > deepest) {
    return fmt::format("lies in more than {} folders", deepest);
  }
  const auto bad = [](char c) { return c == '\\' || static_cast<unsigned char>(c) < 32; };
  if (std::any_of(name.begin(), name.end(), bad)) return "has a backslash or control character";
  for (std::size_t at = 0; at <= name.size();) {
    const std::size_t end = std::min(name.find('/', at), name.size());
    const std::string_view part = name.substr(at, end - at);
    if (part.empty() || part == "." || part == "..") return "is not a relative path without \"..\"";
    if (part.size() > longest_name) return fmt::format("is longer than {} bytes", longest_name);
    at = end + 1;
  }
  return {};
}

bool is_regular(zip_t* zip, std::uint64_t index) {
  zip_uint8_t system = 0;
  zip_uint32_t attributes = 0;
  if (zip_file_get_external_attributes(zip, index, 0, &system, &attributes) != 0) return true;
  const mode_t type = (attributes >> 16) & S_IFMT;
  return system != ZIP_OPSYS_UNIX || type == 0 || S_ISREG(type);
}

/// The files of the archive. Names that end with '/' are folders, which files create.
std::vector<ArchiveFile> entries_of(zip_t* zip, std::uint64_t max_bytes) {
  const zip_int64_t count = zip_get_num_entries(zip, 0);
  if (count > max_archived_files) {
    throw BadArchive(fmt::format("it has {} entries; at most {}", count, max_archived_files));
  }
  std::vector<ArchiveFile> entries;
  std::uint64_t bytes = 0;
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(count); ++i) {
    zip_stat_t stat;
    constexpr zip_uint64_t needed = ZIP_STAT_NAME | ZIP_STAT_SIZE;
    if (zip_stat_index(zip, i, 0, &stat) != 0 || (stat.valid & needed) != needed) {
      throw BadArchive(fmt::format("entry {} has no name or no size", i));
    }
    const std::string name = stat.name;
    if (name.ends_with('/') || is_of_macos(name)) continue;
    if (const std::string fault = fault_of_name(name); !fault.empty()) {
      throw BadArchive(fmt::format("\"{}\" {}", name, fault));
    }
    if (!is_regular(zip, i)) throw BadArchive(fmt::format("\"{}\" is not a regular file", name));
    if (stat.size > max_bytes - bytes) {
      throw BadArchive("unpacked it is larger than " + byte_size_text(max_bytes));
    }
    bytes += stat.size;
    entries.push_back({i, name, stat.size});
  }
  return entries;
}

/// The folder in the archive that has the scene: "" or "NAME/".
std::string top_of(const std::vector<ArchiveFile>& entries) {
  std::string top;
  for (const ArchiveFile& e : entries) {
    if (e.name == archived_scene) return "";
    const std::size_t slash = e.name.find('/');
    if (slash != std::string::npos && e.name.substr(slash + 1) == archived_scene) {
      top = e.name.substr(0, slash + 1);
    }
  }
  if (!top.empty()) return top;
  throw BadArchive(fmt::format("it has no {} at its top, nor in one folder there", archived_scene));
}

void unpack(zip_t* zip, const ArchiveFile& entry, const fs::path& file) {
  const ZipFile from(zip_fopen_index(zip, entry.index, 0), &zip_fclose);
  if (!from) throw BadArchive(fmt::format("\"{}\": {}", entry.name, zip_strerror(zip)));
  fs::create_directories(file.parent_path());
  FileHandle to(::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644));
  if (!to && errno == EEXIST) throw BadArchive(fmt::format("\"{}\" stands twice", entry.name));
  if (!to) throw_file_error(errno, "create", file);
  std::vector<char> buffer(1 << 16);
  std::uint64_t left = entry.bytes;
  for (;;) {
    const zip_int64_t n = zip_fread(from.get(), buffer.data(), buffer.size());
    if (n < 0 || static_cast<std::uint64_t>(n) > left) {
      throw BadArchive(fmt::format("\"{}\" is damaged", entry.name));
    }
    if (n == 0) break;
    left -= static_cast<std::uint64_t>(n);
    for (zip_int64_t done = 0; done < n;) {
      const ssize_t written =
          ::write(to.get(), buffer.data() + done, static_cast<std::size_t>(n - done));
      if (written < 0 && errno != EINTR) throw_file_error(errno, "write", file);
      if (written > 0) done += written;
    }
  }
  if (left > 0) throw BadArchive(fmt::format("\"{}\" is damaged", entry.name));
  if (!to.close()) throw_file_error(errno, "write", file);
}

}  // namespace

void unpack_scene(const fs::path& archive, const fs::path& folder, std::uint64_t max_bytes) {
  const Zip zip = open_archive(archive);
  const std::vector<ArchiveFile> entries = entries_of(zip.get(), max_bytes);
  const std::string top = top_of(entries);
  for (const ArchiveFile& e : entries) {
    if (!e.name.starts_with(top)) {
      throw BadArchive(
          fmt::format("\"{}\" lies beside the folder \"{}\" of the scene", e.name, top));
    }
  }
  fs::create_directory(folder);
  try {
    for (const ArchiveFile& e : entries) unpack(zip.get(), e, folder / e.name.substr(top.size()));
  } catch (const fs::filesystem_error& error) {
    // Another entry is a file where this one has a folder.
    if (error.code() != std::errc::not_a_directory && error.code() != std::errc::file_exists) throw;
    throw BadArchive("a file and a folder have one name: " + error.path1().filename().string());
  }
  const FileHandle there(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!there || ::syncfs(there.get()) != 0) throw_file_error(errno, "sync", folder);
}

}  // namespace lacuna
