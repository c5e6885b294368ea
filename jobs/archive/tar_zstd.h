#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "jobs/archive/manifest.h"

struct archive;

namespace lacuna {

/// Writes a tar compressed by zstd, under a temporary name until finish(). All functions throw
/// std::system_error, or std::runtime_error that names the file.
class TarWriter {
 public:
  explicit TarWriter(std::filesystem::path file);
  ~TarWriter();  ///< removes an unfinished file
  TarWriter(const TarWriter&) = delete;
  TarWriter& operator=(const TarWriter&) = delete;

  /// Adds a regular file as `name`; returns its size and hash as they were written.
  ArchivedFile add_file(const std::string& name, const std::filesystem::path& from);
  void add_text(const std::string& name, std::string_view text, bool executable = false);
  void finish();

 private:
  void begin(const std::string& name, std::uint64_t bytes, bool executable);
  void write(std::span<const char> part);
  [[noreturn]] void fail() const;

  std::filesystem::path file_, draft_;
  std::unique_ptr<archive, int (*)(archive*)> archive_;
};

/// A file in a tar, while it is read.
class TarEntry {
 public:
  virtual ~TarEntry() = default;
  virtual const std::string& name() const = 0;
  /// The whole content, of at most `max_bytes`. Throws std::runtime_error.
  virtual std::string text(std::size_t max_bytes) = 0;
  /// Size and hash of the content, which is not kept.
  virtual ArchivedFile measure() = 0;
};

/// Calls `each` for every regular file of a tar, compressed or not, in its order. Nothing is
/// extracted. Throws std::runtime_error for what is no tar, is damaged, or has more than a million
/// entries.
void read_tar(const std::filesystem::path& file, const std::function<void(TarEntry&)>& each);

}  // namespace lacuna
