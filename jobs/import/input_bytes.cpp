#include "jobs/import/input_bytes.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <stdexcept>

#include "base/storage/input_file.h"
#include "renderer/core/scene_error.h"

namespace lacuna {

std::string unzip(std::span<const std::uint8_t> bytes, std::uint64_t max_bytes,
                  const std::string& label) {
  z_stream stream{};
  constexpr int any_window_and_header = 15 + 32;
  if (inflateInit2(&stream, any_window_and_header) != Z_OK) throw std::bad_alloc();
  const auto end = [](z_stream* s) { inflateEnd(s); };
  const std::unique_ptr<z_stream, decltype(end)> closing(&stream, end);
  constexpr std::size_t piece = std::size_t{1} << 20;
  std::string out;
  std::size_t taken = 0;
  int status = Z_OK;
  while (status == Z_OK) {
    if (stream.avail_in == 0) {  // zlib counts in 32 bits
      const std::size_t more = std::min<std::size_t>(bytes.size() - taken, piece);
      // zlib does not write to its input.
      stream.next_in = const_cast<Bytef*>(bytes.data() + taken);
      stream.avail_in = static_cast<uInt>(more);
      taken += more;
    }
    const std::size_t before = out.size();
    out.resize(before + piece);
    stream.next_out = reinterpret_cast<Bytef*>(out.data() + before);
    stream.avail_out = static_cast<uInt>(piece);
    status = inflate(&stream, Z_NO_FLUSH);
    out.resize(out.size() - stream.avail_out);
    if (out.size() > max_bytes) {
      throw SceneError(fmt::format("{}: more than {} bytes when decompressed", label, max_bytes));
    }
  }
  if (status != Z_STREAM_END)
    throw SceneError(fmt::format("{}: damaged or truncated compressed data", label));
  return out;
}

std::string read_unzipped(const std::filesystem::path& file, std::uint64_t max_bytes) {
  InputFile about;
  InputBytes bytes;
  try {
    bytes = read_input(file, max_bytes, about);
  } catch (const std::logic_error& e) {  // its reason does not name the file
    throw SceneError(fmt::format("{}: {}", file.string(), e.what()));
  }
  if (bytes.size() >= 2 && bytes[0] == 0x1f && bytes[1] == 0x8b) {
    return unzip(bytes, max_bytes, file.string());
  }
  return {bytes.begin(), bytes.end()};
}

}  // namespace lacuna
