#include "analysis/artefacts/entry_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <system_error>

#include "base/storage/checksum.h"
#include "base/storage/file_handle.h"

namespace lacuna {
namespace {

constexpr std::string_view suffix = ".artefact";
constexpr std::size_t hash_digits = 32;

// Not text, and damaged by a conversion of line ends or encodings.
constexpr std::array<char, 8> magic{'\x89', 'L', 'A', 'C', 'U', 'N', 'A', '\n'};
/// Changes whenever the layout of the file changes.
constexpr std::uint32_t format_version = 1;
constexpr std::uint32_t max_header_bytes = 1 << 16;

/// The start of the file. The checksum covers all bytes but its own.
struct Prefix {
  std::array<char, 8> magic;
  std::uint32_t format;
  std::uint32_t header_bytes;
  std::uint64_t packed_bytes, content_bytes;
  std::uint64_t checksum;
};
static_assert(sizeof(Prefix) == 40 && offsetof(Prefix, checksum) == 32);

std::string name_of(std::string_view key_text) { return key_hash(key_text) + std::string(suffix); }

/// Refusals are thrown inside this file only.
struct Refused {
  EntryRefusal refusal;
};
[[noreturn]] void refuse(EntryFault fault, std::string text) {
  throw Refused{{fault, std::move(text)}};
}

/// All `n` bytes at `offset`.
void read_at(int fd, std::uint64_t offset, void* to, std::size_t n) {
  auto* at = static_cast<char*>(to);
  while (n > 0) {
    const ssize_t got = ::pread(fd, at, n, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw std::system_error(errno, std::generic_category(), "read");
    if (got == 0) refuse(EntryFault::cut_short, "cut short");
    at += got;
    offset += static_cast<std::uint64_t>(got);
    n -= static_cast<std::size_t>(got);
  }
}

void check_sizes(const Prefix& p, std::uint64_t file_bytes) {
  if (p.header_bytes > max_header_bytes) {
    refuse(EntryFault::damaged, fmt::format("damaged (a header of {} bytes)", p.header_bytes));
  }
  const std::uint64_t before = sizeof(Prefix) + p.header_bytes;
  if (file_bytes < before || file_bytes - before < p.packed_bytes) {
    refuse(EntryFault::cut_short, fmt::format("cut short: it has {} bytes", file_bytes));
  }
  if (file_bytes - before > p.packed_bytes) {
    refuse(EntryFault::damaged, "damaged (longer than its header says)");
  }
  if (p.content_bytes > most_content(p.packed_bytes)) {
    refuse(EntryFault::damaged, "damaged (its content cannot have the size in its header)");
  }
}

/// An entry whose header was read.
class OpenEntry {
 public:
  OpenEntry(const std::filesystem::path& file, EntryHeader& header) {
    std::uint64_t bytes = 0;
    file_ = open_regular_file(file, bytes);
    read_prefix(bytes);
    read_header(header);
  }

  void check_checksum() const {
    Checksum sum;
    sum.add(&prefix_, offsetof(Prefix, checksum));
    std::string block(std::size_t{1} << 18, '\0');
    std::uint64_t at = sizeof(Prefix);
    for (const std::uint64_t end = content_offset() + prefix_.packed_bytes; at < end;) {
      const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(block.size(), end - at));
      read_at(file_.get(), at, block.data(), n);
      sum.add(block.data(), n);
      at += n;
    }
    if (sum.value() != prefix_.checksum) {
      refuse(EntryFault::damaged, "damaged (its checksum differs)");
    }
  }

  ArtefactReader content() const {
    return {file_.get(), content_offset(), prefix_.packed_bytes, prefix_.content_bytes};
  }

 private:
  std::uint64_t content_offset() const { return sizeof(Prefix) + prefix_.header_bytes; }

  void read_prefix(std::uint64_t file_bytes) {
    const std::size_t there = std::min<std::uint64_t>(file_bytes, sizeof(Prefix));
    read_at(file_.get(), 0, &prefix_, there);
    const std::size_t of_magic = std::min(there, magic.size());
    if (!std::equal(magic.begin(), magic.begin() + of_magic, prefix_.magic.begin())) {
      refuse(EntryFault::foreign, "not an entry of a Lacuna cache");
    }
    if (there < sizeof(Prefix)) {
      refuse(EntryFault::cut_short, fmt::format("cut short: it has {} bytes", file_bytes));
    }
    if (prefix_.format != format_version) {
      refuse(EntryFault::other_version, fmt::format("of format version {}; this one reads {}",
                                                    prefix_.format, format_version));
    }
    check_sizes(prefix_, file_bytes);
  }

  void read_header(EntryHeader& header) const {
    std::string bytes(prefix_.header_bytes, '\0');
    read_at(file_.get(), sizeof(Prefix), bytes.data(), bytes.size());
    ByteReader in(bytes);
    try {
      header.version = in.get<std::uint32_t>();
      header.type = in.get_string();
      header.key = in.get_string();
      header.label = in.get_string();
    } catch (const std::runtime_error&) {
      refuse(EntryFault::damaged, "damaged (its header ends early)");
    }
    if (!in.at_end()) refuse(EntryFault::damaged, "damaged (its header is too long)");
    header.packed_bytes = prefix_.packed_bytes;
    header.content_bytes = prefix_.content_bytes;
  }

  FileHandle file_;
  Prefix prefix_{};
};

void check_key(const ArtefactKey& key, const EntryHeader& header) {
  if (header.key == key.text()) return;
  if (header.type == key.type() && header.version != key.version()) {
    refuse(EntryFault::other_version, fmt::format("of version {} of \"{}\"; this one makes {}",
                                                  header.version, key.type(), key.version()));
  }
  refuse(EntryFault::other_key, "of another artefact (its key differs)");
}

void check_file_name(const std::filesystem::path& file, const EntryHeader& header) {
  if (file.filename() != name_of(header.key)) {
    refuse(EntryFault::other_key, "of another artefact (its name does not match its key)");
  }
}

/// Runs `action` and returns its refusal, if any.
std::optional<EntryRefusal> refusal_of(const std::function<void()>& action) {
  try {
    action();
    return std::nullopt;
  } catch (const Refused& refused) {
    return refused.refusal;
  } catch (const std::system_error& e) {
    const bool missing = e.code() == std::errc::no_such_file_or_directory;
    return EntryRefusal{missing ? EntryFault::missing : EntryFault::unreadable, e.what()};
  }
}

}  // namespace

std::string entry_name(const ArtefactKey& key) { return name_of(key.text()); }

bool is_entry_name(std::string_view name) {
  if (name.size() != hash_digits + suffix.size() || !name.ends_with(suffix)) return false;
  return name.find_first_not_of("0123456789abcdef") == hash_digits;
}

std::string pack_entry(const ArtefactKey& key, const std::string& label,
                       const std::function<void(ArtefactWriter&)>& encode) {
  ByteWriter header;
  header.put(key.version());
  header.put(std::string_view(key.type()));
  header.put(std::string_view(key.text()));
  header.put(std::string_view(label));
  if (header.bytes().size() > max_header_bytes) {
    throw std::invalid_argument(
        fmt::format("an artefact's key and label have {} bytes; allowed: {}", header.bytes().size(),
                    max_header_bytes));
  }
  const Prefix prefix{
      magic, format_version, static_cast<std::uint32_t>(header.bytes().size()), 0, 0, 0};
  std::string entry(reinterpret_cast<const char*>(&prefix), sizeof prefix);
  entry += header.bytes();
  ArtefactWriter content(entry);
  encode(content);
  content.finish();
  seal_entry(entry, content.written());
  return entry;
}

void seal_entry(std::string& entry, std::uint64_t content_bytes) {
  Prefix prefix{};
  std::memcpy(&prefix, entry.data(), sizeof prefix);
  prefix.packed_bytes = entry.size() - sizeof prefix - prefix.header_bytes;
  prefix.content_bytes = content_bytes;
  Checksum sum;
  sum.add(&prefix, offsetof(Prefix, checksum));
  sum.add(entry.data() + sizeof prefix, entry.size() - sizeof prefix);
  prefix.checksum = sum.value();
  std::memcpy(entry.data(), &prefix, sizeof prefix);
}

std::optional<EntryRefusal> read_entry_header(const std::filesystem::path& file,
                                              EntryHeader& header) {
  return refusal_of([&] { OpenEntry(file, header); });
}

std::optional<EntryRefusal> verify_entry(const std::filesystem::path& file, EntryHeader& header) {
  return refusal_of([&] {
    const OpenEntry entry(file, header);
    entry.check_checksum();
    check_file_name(file, header);
  });
}

std::optional<EntryRefusal> read_entry(const std::filesystem::path& file, const ArtefactKey& key,
                                       EntryHeader& header,
                                       const std::function<void(ArtefactReader&)>& decode) {
  return refusal_of([&] {
    const OpenEntry entry(file, header);
    entry.check_checksum();
    check_key(key, header);
    ArtefactReader content = entry.content();
    try {
      decode(content);
      content.finish();
    } catch (const std::system_error&) {
      throw;
    } catch (const std::runtime_error& e) {
      refuse(EntryFault::undecodable, fmt::format("cannot be used: {}", e.what()));
    }
  });
}

}  // namespace lacuna
