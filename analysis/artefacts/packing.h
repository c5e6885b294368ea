#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "base/storage/bytes.h"

struct ZSTD_CCtx_s;
struct ZSTD_DCtx_s;

namespace lacuna {

/// Compresses its input (zstd) and appends the result to a string.
class ArtefactWriter : public PutsValues<ArtefactWriter> {
 public:
  /// `packed` outlives the writer.
  explicit ArtefactWriter(std::string& packed);
  ~ArtefactWriter();

  /// Called once for each block of some hundred KiB from now on; may throw.
  void before_block(std::function<void()> call) { before_block_ = std::move(call); }
  void append(const void* from, std::size_t n);
  /// Number of input bytes so far.
  std::uint64_t written() const { return written_; }
  /// Call after the last input.
  void finish() { compress(nullptr, 0, true); }

 private:
  void compress(const void* from, std::size_t n, bool last);

  std::unique_ptr<ZSTD_CCtx_s, std::size_t (*)(ZSTD_CCtx_s*)> context_;
  std::string& packed_;
  std::string block_;
  std::uint64_t written_ = 0;
  std::function<void()> before_block_;
};

/// Decompresses the output of an ArtefactWriter, one block of the file at a time. Throws
/// std::runtime_error for invalid or truncated data.
class ArtefactReader : public GetsValues<ArtefactReader> {
 public:
  /// `fd`: an open file with `packed_bytes` of compressed data at `offset`, whose header claims
  /// `content_bytes` of content.
  ArtefactReader(int fd, std::uint64_t offset, std::uint64_t packed_bytes,
                 std::uint64_t content_bytes);
  ~ArtefactReader();

  /// Called once for each block of some hundred KiB from now on; may throw.
  void before_block(std::function<void()> call) { before_block_ = std::move(call); }
  void read(void* to, std::size_t n);
  /// Bytes of content not yet read.
  std::uint64_t remaining() const { return remaining_; }
  /// Throws unless all content was read and no data follows.
  void finish();

 private:
  /// Reads the next block of the file, if any.
  void refill();
  /// Decompresses at most `n` bytes; returns how many.
  std::size_t unpack(void* to, std::size_t n);

  std::unique_ptr<ZSTD_DCtx_s, std::size_t (*)(ZSTD_DCtx_s*)> context_;
  int fd_;
  std::uint64_t offset_, packed_left_, remaining_;
  std::string block_;
  std::size_t used_ = 0;  // of block_
  bool frame_ended_ = false;
  std::function<void()> before_block_;
};

/// Upper bound of the content of `packed_bytes`: a zstd block has at least four bytes and at most
/// 128 KiB of content.
constexpr std::uint64_t most_content(std::uint64_t packed_bytes) {
  return (packed_bytes / 4 + 1) << 17;
}

}  // namespace lacuna
