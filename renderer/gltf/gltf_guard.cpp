#include "renderer/gltf/gltf_guard.h"

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "renderer/geometry/scene_data.h"

namespace lacuna::gltf {
namespace {

constexpr std::uint32_t magic_glb = 0x46546C67;   // "glTF"
constexpr std::uint32_t chunk_json = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t chunk_bin = 0x004E4942;   // "BIN\0"
constexpr std::uint64_t header_bytes = 12;
constexpr std::uint64_t chunk_header_bytes = 8;
constexpr int max_depth = 64;

std::uint32_t u32_at(std::span<const std::uint8_t> bytes, std::uint64_t offset) {
  std::uint32_t value = 0;  // x86-64 is little-endian, as is GLB
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

/// The library's own builder with a limit of nesting. The library's callback would
/// get the depth as well; with a callback, however, each end of an object searches the whole array
/// around it, and a scene of a million nodes takes hours.
class ShallowBuilder : public nlohmann::detail::json_sax_dom_parser<Json> {
  using Base = nlohmann::detail::json_sax_dom_parser<Json>;

 public:
  using Base::Base;
  bool start_object(std::size_t size) { return enter() && Base::start_object(size); }
  bool start_array(std::size_t size) { return enter() && Base::start_array(size); }
  bool end_object() { return leave() && Base::end_object(); }
  bool end_array() { return leave() && Base::end_array(); }

 private:
  bool enter() {
    if (++depth_ > max_depth) {
      throw SceneError("JSON: nested more than " + std::to_string(max_depth) + " levels deep");
    }
    return true;
  }
  bool leave() { return depth_-- > 0; }

  int depth_ = 0;
};

}  // namespace

Framing check_framing(std::span<const std::uint8_t> file) {
  const auto fail = [](const std::string& what) { throw SceneError("GLB header: " + what); };
  if (file.size() < 4 || u32_at(file, 0) != magic_glb) return {false, file, 0};

  if (file.size() < header_bytes + chunk_header_bytes) {
    fail("the file ends after " + std::to_string(file.size()) + " bytes; at least 20 are needed");
  }
  if (u32_at(file, 4) != 2) {
    fail("version is " + std::to_string(u32_at(file, 4)) + "; allowed: 2");
  }
  const std::uint64_t length = u32_at(file, 8);
  if (length != file.size()) {
    fail("length is " + std::to_string(length) + "; the file has " + std::to_string(file.size()) +
         " bytes");
  }
  const std::uint64_t json_bytes = u32_at(file, 12);
  const std::uint64_t json_end = header_bytes + chunk_header_bytes + json_bytes;
  if (u32_at(file, 16) != chunk_json) fail("the first chunk is not JSON");
  if (json_end > length) {
    fail("the JSON chunk of " + std::to_string(json_bytes) + " bytes goes beyond the file's " +
         std::to_string(length));
  }
  Framing framing{true, file.subspan(header_bytes + chunk_header_bytes, json_bytes), 0};
  if (json_end == length) return framing;

  if (json_end + chunk_header_bytes > length) fail("the second chunk has no complete header");
  const std::uint64_t bin_bytes = u32_at(file, json_end);
  if (u32_at(file, json_end + 4) != chunk_bin) fail("the second chunk is not BIN");
  if (json_end + chunk_header_bytes + bin_bytes > length) {
    fail("the BIN chunk of " + std::to_string(bin_bytes) + " bytes goes beyond the file's " +
         std::to_string(length));
  }
  framing.bin_bytes = bin_bytes;
  framing.bin_begin = json_end + chunk_header_bytes;
  return framing;
}

Json parse_json(std::span<const std::uint8_t> text) {
  Json json;
  ShallowBuilder builder(json);
  try {
    Json::sax_parse(text.begin(), text.end(), &builder);
  } catch (const Json::parse_error& e) {
    throw SceneError("JSON: it breaks off, or is none, at byte " + std::to_string(e.byte));
  } catch (const Json::out_of_range&) {
    throw SceneError("JSON: a number is larger than a double can be");
  }
  return json;
}

}  // namespace lacuna::gltf
