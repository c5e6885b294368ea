#include "analysis/artefacts/packing.h"

#include <fmt/format.h>
#include <unistd.h>
#include <zstd.h>
#include <zstd_errors.h>

#include <algorithm>
#include <cerrno>
#include <new>
#include <system_error>

namespace lacuna {
namespace {

// Prefers speed: caching an artefact pays only if it loads faster than it is built.
constexpr int level = 1;

std::size_t check(std::size_t result) {
  if (ZSTD_isError(result) == 0) return result;
  if (ZSTD_getErrorCode(result) == ZSTD_error_memory_allocation) throw std::bad_alloc();
  throw std::runtime_error(
      fmt::format("its content cannot be decompressed: {}", ZSTD_getErrorName(result)));
}

[[noreturn]] void throw_early_end() { throw std::runtime_error("its content ends early"); }

}  // namespace

ArtefactWriter::ArtefactWriter(std::string& packed)
    : context_(ZSTD_createCCtx(), ZSTD_freeCCtx),
      packed_(packed),
      block_(ZSTD_CStreamOutSize(), '\0') {
  if (!context_) throw std::bad_alloc();
  check(ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_compressionLevel, level));
}

ArtefactWriter::~ArtefactWriter() = default;

void ArtefactWriter::append(const void* from, std::size_t n) {
  compress(from, n, false);
  written_ += n;
}

void ArtefactWriter::compress(const void* from, std::size_t n, bool last) {
  ZSTD_inBuffer in{from, n, 0};
  for (;;) {
    if (before_block_) before_block_();
    ZSTD_outBuffer out{block_.data(), block_.size(), 0};
    const std::size_t left =
        check(ZSTD_compressStream2(context_.get(), &out, &in, last ? ZSTD_e_end : ZSTD_e_continue));
    packed_.append(block_.data(), out.pos);
    if (last ? left == 0 : in.pos == in.size) return;
  }
}

ArtefactReader::ArtefactReader(int fd, std::uint64_t offset, std::uint64_t packed_bytes,
                               std::uint64_t content_bytes)
    : context_(ZSTD_createDCtx(), ZSTD_freeDCtx),
      fd_(fd),
      offset_(offset),
      packed_left_(packed_bytes),
      remaining_(content_bytes) {
  if (!context_) throw std::bad_alloc();
  // For a frame that claims to need more than any frame of this writer.
  check(ZSTD_DCtx_setParameter(context_.get(), ZSTD_d_windowLogMax, 24));
}

ArtefactReader::~ArtefactReader() = default;

void ArtefactReader::read(void* to, std::size_t n) {
  if (n > remaining_) throw_early_end();
  auto* at = static_cast<char*>(to);
  while (n > 0) {
    const std::size_t got = unpack(at, n);
    if (got == 0) throw_early_end();
    at += got;
    n -= got;
    remaining_ -= got;
  }
}

void ArtefactReader::finish() {
  char more = 0;
  if (remaining_ > 0 || unpack(&more, 1) > 0 || packed_left_ > 0 || used_ < block_.size()) {
    throw std::runtime_error("its content has extra bytes at its end");
  }
  if (!frame_ended_) throw_early_end();
}

std::size_t ArtefactReader::unpack(void* to, std::size_t n) {
  ZSTD_outBuffer out{to, n, 0};
  while (out.pos < n && !frame_ended_) {
    if (used_ == block_.size()) refill();
    ZSTD_inBuffer in{block_.data(), block_.size(), used_};
    const std::size_t before = out.pos;
    frame_ended_ = check(ZSTD_decompressStream(context_.get(), &out, &in)) == 0;
    const bool moved = in.pos > used_ || out.pos > before;
    used_ = in.pos;
    if (!moved && (packed_left_ == 0 || used_ < block_.size())) break;
  }
  return out.pos;
}

void ArtefactReader::refill() {
  if (before_block_) before_block_();
  constexpr std::uint64_t block = 1 << 17;
  block_.resize(static_cast<std::size_t>(std::min(block, packed_left_)));
  used_ = 0;
  std::size_t filled = 0;
  while (filled < block_.size()) {
    const ssize_t n = ::pread(fd_, block_.data() + filled, block_.size() - filled,
                              static_cast<off_t>(offset_ + filled));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw std::system_error(errno, std::generic_category(), "read");
    if (n == 0) throw_early_end();
    filled += static_cast<std::size_t>(n);
  }
  offset_ += filled;
  packed_left_ -= filled;
}

}  // namespace lacuna
