#include <algorithm>
#include <array>
#include <utility>

#include "renderer/images/checked_bytes.h"
#include "renderer/images/guards.h"

namespace lacuna {
namespace {

// Markers: the byte after 0xFF (ITU T.81, table B.1).
constexpr std::uint8_t start_of_image = 0xD8, end_of_image = 0xD9, start_of_scan = 0xDA,
                       arithmetic_tables = 0xCC, huffman_tables = 0xC4, jpeg_extension = 0xC8,
                       app0 = 0xE0, adobe = 0xEE, last_app = 0xEF, comment = 0xFE;
/// Frames that the library decodes: baseline, extended and progressive, Huffman or arithmetic.
constexpr std::array<std::uint8_t, 5> frames{0xC0, 0xC1, 0xC2, 0xC9, 0xCA};
/// With more scans a small file takes minutes.
constexpr int most_scans = 500;

bool is_restart(std::uint8_t marker) { return marker >= 0xD0 && marker <= 0xD7; }
bool begins_frame(std::uint8_t marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != huffman_tables && marker != jpeg_extension &&
         marker != arithmetic_tables;
}
/// Whether texels depend on a segment: not on comments, nor on application data other than JFIF's
/// and Adobe's, which define the colours.
bool makes_texels(std::uint8_t marker) {
  if (marker >= app0 && marker <= last_app) return marker == app0 || marker == adobe;
  return marker != comment;
}

/// Validates a frame and returns its number of texels.
std::uint64_t check_frame(std::uint8_t marker, CheckedBytes segment) {
  if (std::find(frames.begin(), frames.end(), marker) == frames.end()) {
    segment.fail("is coded as frame type " + std::to_string(marker - 0xC0) +
                 "; allowed: baseline, extended and progressive");
  }
  const int bits = segment.byte();
  const std::uint32_t height = segment.big_endian(2), width = segment.big_endian(2);
  const int components = segment.byte();
  if (bits != 8) segment.fail("has " + std::to_string(bits) + " bits a channel; allowed: 8");
  segment.require_size(width, height, max_texture_side, "texels");
  if (components == 4) segment.fail("is a CMYK JPEG; allowed: grey and RGB");
  if (components != 1 && components != 3) {
    segment.fail("has " + std::to_string(components) + " channels; allowed: 1 and 3");
  }
  return std::uint64_t{width} * height;
}

class JpegGuard {
 public:
  JpegGuard(std::span<const std::uint8_t> jpeg, const std::string& label)
      : in_(jpeg, label), label_(label) {
    plain_.reserve(jpeg.size());
  }

  /// The number of texels of the first frame.
  std::uint64_t texels() {
    while (texels_ == 0) {
      const std::uint8_t marker = next_marker();
      if (marker == end_of_image) in_.fail("is corrupt: there is no image in it");
      if (marker != start_of_image && !is_restart(marker)) read_segment(marker);
    }
    return texels_;
  }

  std::vector<std::uint8_t> run() {
    for (std::uint8_t marker = next_marker(); marker != end_of_image; marker = next_marker()) {
      if (marker != start_of_image && !is_restart(marker)) read_segment(marker);
    }
    if (!framed_ || scans_ == 0) in_.fail("is corrupt: there is no image in it");
    return std::move(plain_);
  }

 private:
  /// A marker may be preceded by any number of 0xFF.
  std::uint8_t next_marker() {
    if (in_.byte() != 0xFF) in_.fail("is corrupt: a marker is missing");
    std::uint8_t marker = 0xFF;
    while (marker == 0xFF) marker = in_.byte();
    if (marker == start_of_image || marker == end_of_image || is_restart(marker)) {
      plain_.insert(plain_.end(), {0xFF, marker});
    }
    return marker;
  }

  void read_segment(std::uint8_t marker) {
    const std::size_t begin = in_.at();
    const std::uint32_t length = in_.big_endian(2);
    if (length < 2) in_.fail("is corrupt: a segment has no length");
    const auto content = in_.take(length - 2);
    if (begins_frame(marker)) {
      if (std::exchange(framed_, true)) in_.fail("has several frames; allowed: one");
      texels_ = check_frame(marker, {content, label_});
    }
    if (marker == start_of_scan) {
      if (++scans_ > most_scans) {
        in_.fail("has more than " + std::to_string(most_scans) + " scans");
      }
      skip_scan();
    }
    if (!makes_texels(marker)) return;
    plain_.insert(plain_.end(), {0xFF, marker});
    const auto all = in_.since(begin);
    plain_.insert(plain_.end(), all.begin(), all.end());
  }

  /// Skips to the marker after the scan: 0xFF 0x00 is an escaped 0xFF, and restart markers belong
  /// to the scan.
  void skip_scan() {
    for (;;) {
      CheckedBytes ahead = in_;
      if (ahead.byte() == 0xFF) {
        const std::uint8_t next = ahead.byte();
        if (next != 0 && !is_restart(next)) return;
      }
      in_.take(1);
    }
  }

  CheckedBytes in_;
  const std::string& label_;
  std::vector<std::uint8_t> plain_;
  bool framed_ = false;
  std::uint64_t texels_ = 0;
  int scans_ = 0;
};

}  // namespace

std::uint64_t jpeg_texels(std::span<const std::uint8_t> jpeg, const std::string& label) {
  return JpegGuard(jpeg, label).texels();
}

std::vector<std::uint8_t> plain_jpeg(std::span<const std::uint8_t> jpeg, const std::string& label) {
  return JpegGuard(jpeg, label).run();
}

}  // namespace lacuna
