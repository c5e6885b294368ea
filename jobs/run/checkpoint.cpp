#include "jobs/run/checkpoint.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <limits>
#include <stdexcept>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/bytes.h"

namespace lacuna {

namespace {

// Changes with the layout of anything that is saved.
constexpr std::string_view format_name = "lacuna-checkpoint-4";

}  // namespace

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
