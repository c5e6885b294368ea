#include "jobs/import/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include "base/json/json_cursor.h"
#include "renderer/core/scene_error.h"

namespace lacuna {
namespace {

constexpr std::size_t max_header_bytes = 65536, max_properties = 256;

struct TypeName {
  std::string_view name;
  PlyHeader::Type type;
};
constexpr std::array<TypeName, 16> type_names{{{"char", PlyHeader::Type::int8},
                                               {"int8", PlyHeader::Type::int8},
                                               {"uchar", PlyHeader::Type::uint8},
                                               {"uint8", PlyHeader::Type::uint8},
                                               {"short", PlyHeader::Type::int16},
                                               {"int16", PlyHeader::Type::int16},
                                               {"ushort", PlyHeader::Type::uint16},
                                               {"uint16", PlyHeader::Type::uint16},
                                               {"int", PlyHeader::Type::int32},
                                               {"int32", PlyHeader::Type::int32},
                                               {"uint", PlyHeader::Type::uint32},
                                               {"uint32", PlyHeader::Type::uint32},
                                               {"float", PlyHeader::Type::float32},
                                               {"float32", PlyHeader::Type::float32},
                                               {"double", PlyHeader::Type::float64},
                                               {"float64", PlyHeader::Type::float64}}};

/// The lines of a header, split at blanks.
class HeaderLines {
 public:
  HeaderLines(std::span<const std::uint8_t> file, const std::string& label)
      : text_(reinterpret_cast<const char*>(file.data()), std::min(file.size(), max_header_bytes)),
        label_(label) {}

  std::vector<std::string_view> next() {
    const auto end = text_.find('\n', at_);
    if (end == std::string_view::npos) fail("has no line \"end_header\" in its first 65536 bytes");
    std::string_view line = text_.substr(at_, end - at_);
    at_ = end + 1;
    ++number_;
    std::vector<std::string_view> words;
    while (true) {
      const auto from = line.find_first_not_of(" \t\r");
      if (from == std::string_view::npos) return words;
      line.remove_prefix(from);
      const auto to = std::min(line.find_first_of(" \t\r"), line.size());
      words.push_back(line.substr(0, to));
      line.remove_prefix(to);
    }
  }
  std::size_t position() const { return at_; }
  [[noreturn]] void fail(const std::string& what) const {
    throw SceneError(fmt::format("{}: line {} of the header {}", label_, number_, what));
  }
  PlyHeader::Type type(std::string_view name) const {
    for (const TypeName& t : type_names) {
      if (t.name == name) return t.type;
    }
    fail(
        fmt::format("has the type {}; allowed: char, uchar, short, ushort, int, uint, float, "
                    "double",
                    in_quotes(name)));
  }

 private:
  std::string_view text_;
  const std::string& label_;
  std::size_t at_ = 0;
  int number_ = 0;
};

PlyHeader::Encoding encoding_of(const HeaderLines& lines,
                                const std::vector<std::string_view>& words) {
  if (words.size() == 3 && words[2] == "1.0") {
    if (words[1] == "ascii") return PlyHeader::Encoding::ascii;
    if (words[1] == "binary_little_endian") return PlyHeader::Encoding::little_endian;
    if (words[1] == "binary_big_endian") return PlyHeader::Encoding::big_endian;
  }
  lines.fail(
      "is no format that is read; allowed: format ascii, binary_little_endian or "
      "binary_big_endian 1.0");
}

PlyHeader::Element element_of(const HeaderLines& lines,
                              const std::vector<std::string_view>& words) {
  if (words.size() != 3) lines.fail("is no element; expected: element NAME COUNT");
  PlyHeader::Element element;
  element.name = words[1];
  const auto end = words[2].data() + words[2].size();
  const auto read = std::from_chars(words[2].data(), end, element.count);
  if (read.ec != std::errc() || read.ptr != end) {
    lines.fail(fmt::format("has the count {}; allowed: a whole number", in_quotes(words[2])));
  }
  return element;
}

PlyHeader::Property property_of(const HeaderLines& lines,
                                const std::vector<std::string_view>& words) {
  PlyHeader::Property property;
  property.list = words.size() == 5 && words[1] == "list";
  if (!property.list && words.size() != 3) {
    lines.fail("is no property; expected: property TYPE NAME or property list TYPE TYPE NAME");
  }
  if (property.list) property.length_type = lines.type(words[2]);
  property.type = lines.type(words[words.size() - 2]);
  property.name = words.back();
  return property;
}

/// Bytes that an item of an element takes at least: in text a digit and a blank for each value.
std::uint64_t least_bytes(const PlyHeader& header, const PlyHeader::Element& element) {
  std::uint64_t bytes = 0;
  for (const auto& p : element.properties) {
    if (header.encoding == PlyHeader::Encoding::ascii) {
      bytes += 2;
    } else {
      bytes += size_of(p.list ? p.length_type : p.type);
    }
  }
  return bytes;
}

void check_counts(const PlyHeader& header, std::size_t file_bytes, const std::string& label) {
  // The last blank of a text may be missing.
  std::uint64_t remaining = file_bytes - header.bytes + 1;
  for (const auto& e : header.elements) {
    const std::uint64_t each = std::max<std::uint64_t>(1, least_bytes(header, e));
    if (e.count > remaining / each) {
      throw SceneError(fmt::format(
          "{}: the header promises {} items of element {}, and the file has {} bytes left for them",
          label, e.count, in_quotes(e.name), remaining - 1));
    }
    remaining -= e.count * each;
  }
}

}  // namespace

std::size_t size_of(PlyHeader::Type type) {
  switch (type) {
    case PlyHeader::Type::int8:
    case PlyHeader::Type::uint8:
      return 1;
    case PlyHeader::Type::int16:
    case PlyHeader::Type::uint16:
      return 2;
    case PlyHeader::Type::float64:
      return 8;
    default:
      return 4;
  }
}

PlyHeader read_ply_header(std::span<const std::uint8_t> file, const std::string& label) {
  HeaderLines lines(file, label);
  PlyHeader header;
  std::optional<PlyHeader::Encoding> encoding;
  std::size_t properties = 0;
  if (const auto first = lines.next(); first.size() != 1 || first[0] != "ply") {
    lines.fail("is not \"ply\"");
  }
  while (true) {
    const auto words = lines.next();
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") break;
    if (words[0] == "format") {
      encoding = encoding_of(lines, words);
    } else if (words[0] == "element") {
      header.elements.push_back(element_of(lines, words));
    } else if (words[0] == "property") {
      if (header.elements.empty()) lines.fail("is a property of no element");
      if (++properties > max_properties) lines.fail("is a property too many; allowed: 256");
      header.elements.back().properties.push_back(property_of(lines, words));
    } else {
      lines.fail(
          fmt::format("begins with {}; allowed: format, element, property, comment, "
                      "obj_info, end_header",
                      in_quotes(words[0])));
    }
  }
  if (!encoding) lines.fail("ends the header, which names no format");
  header.encoding = *encoding;
  header.bytes = lines.position();
  check_counts(header, file.size(), label);
  return header;
}

}  // namespace lacuna
