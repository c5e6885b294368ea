#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lacuna::test {

/// A GLB of these chunks, padded; the header tells the truth.
inline std::vector<std::uint8_t> frame_glb(std::string json_text,
                                           std::vector<std::uint8_t> bin_chunk) {
  json_text.resize((json_text.size() + 3) / 4 * 4, ' ');
  bin_chunk.resize((bin_chunk.size() + 3) / 4 * 4);
  std::vector<std::uint8_t> out;
  const auto put = [&out](std::size_t value) {
    for (int shift = 0; shift < 32; shift += 8) {
      out.push_back(static_cast<std::uint8_t>(value >> shift));
    }
  };
  const bool has_bin = !bin_chunk.empty();
  put(0x46546C67);
  put(2);
  put(20 + json_text.size() + (has_bin ? 8 + bin_chunk.size() : 0));
  put(json_text.size());
  put(0x4E4F534A);
  out.insert(out.end(), json_text.begin(), json_text.end());
  if (has_bin) {
    put(bin_chunk.size());
    put(0x004E4942);
    out.insert(out.end(), bin_chunk.begin(), bin_chunk.end());
  }
  return out;
}

}  // namespace lacuna::test
