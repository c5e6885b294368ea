#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "analysis/storage/bytes.h"

struct ZSTD_CCtx_s;
struct ZSTD_DCtx_s;

namespace lacuna {

/// Compresses what is put into it (zstd), and appends the result to a string.
class ArtefactWriter : public PutsValues<ArtefactWriter> {
 public:
  /// `packed` outlives the writer.
  explicit ArtefactWriter(std::string& packed);
  ~ArtefactWriter();

  void append(const void* from, std::size_t n);
  /// How many bytes were put in.
  std::uint64_t written() const { return written_; }
  /// No more follows.
  void finish() { compress(nullptr, 0, true); }

 private:
  void compress(const void* from, std::size_t n, bool last);

  std::unique_ptr<ZSTD_CCtx_s, std::size_t (*)(ZSTD_CCtx_s*)> context_;
  std::string& packed_;
  std::string block_;
  std::uint64_t written_ = 0;
};

/// Gives back what an ArtefactWriter was told, a block of the file at a time. Trusts no byte:
/// throws std::runtime_error where they are none of a writer's, or end early.
class ArtefactReader : public GetsValues<ArtefactReader> {
 public:
  /// `fd`: an open file, in which `packed_bytes` lie at `offset`. They say that they hold
  /// `content_bytes`.
  ArtefactReader(int fd, std::uint64_t offset, std::uint64_t packed_bytes,
                 std::uint64_t content_bytes);
  ~ArtefactReader();

  void read(void* to, std::size_t n);
  /// Bytes of the content that were not read yet.
  std::uint64_t remaining() const { return remaining_; }
  /// All of it was read, and nothing follows.
  void finish();

 private:
  /// More of the file, if there is more of it.
  void refill();
  /// At most `n` bytes; returns how many.
  std::size_t unpack(void* to, std::size_t n);

  std::unique_ptr<ZSTD_DCtx_s, std::size_t (*)(ZSTD_DCtx_s*)> context_;
  int fd_;
  std::uint64_t offset_, packed_left_, remaining_;
  std::string block_;
  std::size_t used_ = 0;  // of block_
  bool frame_ended_ = false;
};

/// More content than this never comes out of so many packed bytes: a block of zstd has four bytes
/// or more, and holds 128 KiB at most.
constexpr std::uint64_t most_content(std::uint64_t packed_bytes) {
  return (packed_bytes / 4 + 1) << 17;
}

}  // namespace lacuna
