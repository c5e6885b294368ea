#include "renderer/gltf/gltf_data_uri.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace lacuna::gltf {
namespace {

constexpr auto media_types =
    std::to_array<std::string_view>({"application/octet-stream", "application/gltf-buffer",
                                     "image/png", "image/jpeg", "text/plain"});

constexpr std::uint8_t no_digit = 64;

constexpr std::array<std::uint8_t, 256> base64_values() {
  std::array<std::uint8_t, 256> out{};
  out.fill(no_digit);
  std::uint8_t value = 0;
  for (const char c :
       std::string_view("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/")) {
    out[static_cast<unsigned char>(c)] = value++;
  }
  return out;
}

/// None if `text` is no base64 (RFC 4648); the padding may lack.
std::optional<Bytes> decode_base64(std::string_view text) {
  static constexpr auto values = base64_values();
  while (text.ends_with('=')) text.remove_suffix(1);
  if (text.size() % 4 == 1) return std::nullopt;
  Bytes out;
  out.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    const std::uint8_t value = values[static_cast<unsigned char>(c)];
    if (value == no_digit) return std::nullopt;
    bits = bits << 6 | value;
    held += 6;
    if (held < 8) continue;
    held -= 8;
    out.push_back(static_cast<std::uint8_t>(bits >> held));
  }
  return out;
}

}  // namespace

std::optional<Bytes> decode_data_uri(const GltfObject& place, const std::string& uri) {
  constexpr std::string_view scheme = "data:";
  constexpr std::string_view encoding = ";base64,";
  if (!uri.starts_with(scheme)) return std::nullopt;
  const std::string_view rest = std::string_view(uri).substr(scheme.size());
  const std::string_view type = rest.substr(0, rest.find(encoding));
  if (std::find(media_types.begin(), media_types.end(), type) == media_types.end()) {
    place.fail("uri is a data: URI of an unknown kind (\"" + uri.substr(0, 40) +
               "...\"); allowed: base64 of application/octet-stream, application/gltf-buffer, "
               "image/png or image/jpeg");
  }
  auto bytes = decode_base64(rest.substr(type.size() + encoding.size()));
  if (!bytes) place.fail("uri is a data: URI that is no base64");
  return bytes;
}

}  // namespace lacuna::gltf
