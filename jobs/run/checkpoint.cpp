#include "jobs/run/checkpoint.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <stdexcept>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/bytes.h"
#include "analysis/storage/file_handle.h"

namespace lacuna {

namespace {

// Changes with the layout of anything that is saved.
constexpr std::string_view format_name = "lacuna-checkpoint-4";

std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

}  // namespace

std::string checkpoint_key(const CheckpointKey& key) {
  return fmt::format("{}\n{}\n{}\n{}", key.picture, key.scene, key.version, key.layers);
}

CheckpointKey read_checkpoint_key(const std::filesystem::path& file) {
  std::string head(std::size_t{1} << 16, '\0');  // far more than a key takes
  FileHandle handle(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  const ssize_t size = handle ? ::read(handle.get(), head.data(), head.size()) : -1;
  if (size < 0) throw_file_error(errno, "read", file);
  ByteReader in(std::string_view(head).substr(0, static_cast<std::size_t>(size)));
  try {
    if (in.get_text() != format_name) {
      throw std::runtime_error("not a checkpoint of this version");
    }
    std::string_view text = in.get_text();
    CheckpointKey key;
    for (std::string* part : {&key.picture, &key.scene, &key.version, &key.layers}) {
      *part = take_line(text);
    }
    return key;
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(fmt::format("{}: {}", file.string(), e.what()));
  }
}

void write_checkpoint(const std::filesystem::path& file, const std::string& key,
                      const std::string& content) {
  ByteWriter out;
  out.put(format_name);
  out.put(std::string_view(key));
  out.put(static_cast<std::uint64_t>(XXH3_64bits(content.data(), content.size())));
  out.put(std::string_view(content));
  write_file_atomically(file, out.bytes());
}

std::optional<std::string> read_checkpoint(const std::filesystem::path& file,
                                           const std::string& key) {
  if (!std::filesystem::exists(file)) return std::nullopt;
  const auto refuse = [&](const std::string& why) {
    throw std::runtime_error(fmt::format("{}: {}", file.string(), why));
  };
  const std::string bytes = read_file(file, std::numeric_limits<std::size_t>::max());
  ByteReader in(bytes);
  try {
    if (in.get_text() != format_name) refuse("not a checkpoint of this version");
    if (in.get_text() != key) refuse("a checkpoint of another picture, or of other layers");
    const auto checksum = in.get<std::uint64_t>();
    const std::string_view content = in.get_text();
    if (XXH3_64bits(content.data(), content.size()) != checksum || !in.at_end()) {
      refuse("damaged (its checksum differs)");
    }
    return std::string(content);
  } catch (const std::runtime_error& e) {
    if (std::string_view(e.what()).starts_with(file.string())) throw;
    refuse("cut short");
  }
  return std::nullopt;
}

}  // namespace lacuna
