#include "jobs/run/checkpoint.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "base/storage/atomic_file.h"
#include "base/storage/checksum.h"
#include "base/storage/file_handle.h"

namespace lacuna {

namespace {

// Changes with the layout of any saved data.
constexpr std::string_view format_name = "lacuna-checkpoint-5";
constexpr std::size_t most_text_bytes = std::size_t{1} << 24;  // far more than a key takes

/// The data between the key and the content.
struct FileFrame {
  std::uint64_t checksum = 0, content_bytes = 0;
};

std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

/// A checkpoint whose header was read.
class OpenCheckpoint {
 public:
  explicit OpenCheckpoint(const std::filesystem::path& file)
      : file_(file), handle_(open_regular_file(file, bytes_)) {
    if (take_text() != format_name) throw std::runtime_error("not a checkpoint of this version");
    key_ = take_text();
    take(&frame_, sizeof frame_);
  }

  const std::string& key() const { return key_; }

  /// Throws std::runtime_error if the content differs from what was written.
  void verify(const BetweenPieces& between) const {
    if (bytes_ - start_ < frame_.content_bytes) throw std::runtime_error("truncated");
    Checksum checksum;
    std::string piece(piece_bytes, '\0');
    ByteReader in = content(between);
    while (!in.at_end()) {
      const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(piece_bytes, in.remaining()));
      in.read(piece.data(), n);
      checksum.add(piece.data(), n);
    }
    if (checksum.value() != frame_.checksum || bytes_ - start_ > frame_.content_bytes) {
      throw std::runtime_error("damaged (its checksum differs)");
    }
  }

  ByteReader content(const BetweenPieces& between) const {
    return {frame_.content_bytes, [this, &between, at = start_](char* to, std::size_t n) mutable {
              read_at(at, to, n);
              at += n;
              if (between && at < start_ + frame_.content_bytes) between();
            }};
  }

 private:
  void take(void* to, std::size_t n) {
    if (n > bytes_ - start_) throw std::runtime_error("truncated");
    read_at(start_, static_cast<char*>(to), n);
    start_ += n;
  }
  /// Reads a text of ByteWriter.
  std::string take_text() {
    std::uint64_t size = 0;
    take(&size, sizeof size);
    if (size > most_text_bytes) throw std::runtime_error("damaged (its header is too long)");
    std::string text(static_cast<std::size_t>(size), '\0');
    take(text.data(), text.size());
    return text;
  }
  void read_at(std::uint64_t at, char* to, std::size_t n) const {
    while (n > 0) {
      const ssize_t got = ::pread(handle_.get(), to, n, static_cast<off_t>(at));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) throw_file_error(errno, "read", file_);
      if (got == 0) throw std::runtime_error("truncated");
      to += got;
      at += static_cast<std::uint64_t>(got);
      n -= static_cast<std::size_t>(got);
    }
  }

  std::filesystem::path file_;
  std::uint64_t bytes_ = 0;
  FileHandle handle_;
  std::string key_;
  FileFrame frame_;
  std::uint64_t start_ = 0;  // of the content, after the header
};

/// Runs `read`; adds the file's name to its errors.
void naming(const std::filesystem::path& file, const std::function<void()>& read) {
  try {
    read();
  } catch (const std::system_error&) {
    throw;  // contains the name already
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(fmt::format("{}: {}", file.string(), e.what()));
  }
}

}  // namespace

std::string checkpoint_key(const CheckpointKey& key) {
  return fmt::format("{}\n{}\n{}\n{}", key.picture, key.scene, key.version, key.layers);
}

CheckpointKey read_checkpoint_key(const std::filesystem::path& file) {
  CheckpointKey key;
  naming(file, [&] {
    const OpenCheckpoint checkpoint(file);
    std::string_view text = checkpoint.key();
    for (std::string* part : {&key.picture, &key.scene, &key.version, &key.layers}) {
      *part = take_line(text);
    }
  });
  return key;
}

void write_checkpoint(const std::filesystem::path& file, const std::string& key,
                      const std::function<void(ByteWriter&)>& save, const BetweenPieces& between) {
  ByteWriter header;
  header.put(format_name);
  header.put(std::string_view(key));
  FileFrame frame;
  AtomicFile out(file);
  out.write(header.bytes());
  const auto bytes_of_frame = [&] {
    return std::string_view(reinterpret_cast<const char*>(&frame), sizeof frame);
  };
  out.write(bytes_of_frame());  // rewritten at the end
  Checksum checksum;
  ByteWriter content([&](std::string_view piece) {
    checksum.add(piece.data(), piece.size());
    frame.content_bytes += piece.size();
    out.write(piece);
    if (between) between();
  });
  save(content);
  content.flush();
  frame.checksum = checksum.value();
  out.write_at(header.bytes().size(), bytes_of_frame());
  out.commit();
}

bool read_checkpoint(const std::filesystem::path& file, const std::string& key,
                     const std::function<void(ByteReader&)>& load, const BetweenPieces& between) {
  if (!std::filesystem::exists(file)) return false;
  naming(file, [&] {
    const OpenCheckpoint checkpoint(file);
    if (checkpoint.key() != key) {
      throw std::runtime_error("a checkpoint of another picture or other layers");
    }
    checkpoint.verify(between);
    ByteReader in = checkpoint.content(between);
    load(in);
    if (!in.at_end()) throw std::runtime_error("saved state has extra bytes at its end");
  });
  return true;
}

}  // namespace lacuna
