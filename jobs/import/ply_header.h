#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna {

/// The header of a PLY file.
struct PlyHeader {
  enum class Encoding { ascii, little_endian, big_endian };
  enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
  struct Property {
    std::string name;
    Type type = Type::float32;
    bool list = false;
    Type length_type = Type::uint8;  ///< of a list
  };
  struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
  };

  Encoding encoding = Encoding::ascii;
  std::vector<Element> elements;
  std::size_t bytes = 0;  ///< of the header itself: the values begin there
};

/// Bytes of a value in a binary file.
std::size_t size_of(PlyHeader::Type type);
/// Throws SceneError with `label`; also if an element has more items than the rest of the file can
/// hold.
PlyHeader read_ply_header(std::span<const std::uint8_t> file, const std::string& label);

}  // namespace lacuna
