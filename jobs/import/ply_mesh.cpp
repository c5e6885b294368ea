#include "jobs/import/ply_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>

#include "base/json/json_cursor.h"
#include "jobs/import/ply_header.h"
#include "renderer/core/scene_error.h"

namespace lacuna {
namespace {

template <class T>
double value_of(std::array<std::uint8_t, 8>& bytes) {
  T value;
  std::memcpy(&value, bytes.data(), sizeof value);
  return static_cast<double>(value);
}

/// The values behind the header, one after the other.
class PlyValues {
 public:
  PlyValues(std::span<const std::uint8_t> values, PlyHeader::Encoding encoding,
            const std::string& label)
      : rest_(reinterpret_cast<const char*>(values.data()), values.size()),
        encoding_(encoding),
        label_(label) {}

  double next(PlyHeader::Type type) {
    return encoding_ == PlyHeader::Encoding::ascii ? text() : binary(type);
  }
  /// The length of a list.
  std::uint64_t length(PlyHeader::Type type) {
    const double n = next(type);
    if (!(n >= 0 && n <= static_cast<double>(rest_.size()) + 1 && n == std::floor(n))) {
      fail(
          fmt::format("a list of {} values; allowed: whole numbers, and no more than there are "
                      "bytes left",
                      n));
    }
    return static_cast<std::uint64_t>(n);
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw SceneError(fmt::format("{}: {}", label_, what));
  }

 private:
  double text() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size()));
    const auto end = std::min(rest_.find_first_of(" \t\r\n"), rest_.size());
    double value = 0;
    const auto read = std::from_chars(rest_.data(), rest_.data() + end, value);
    if (end == 0) fail("it ends early");
    if (read.ec != std::errc() || read.ptr != rest_.data() + end) {
      fail(fmt::format("found {}; allowed: a number", in_quotes(rest_.substr(0, end))));
    }
    rest_.remove_prefix(end);
    return value;
  }
  double binary(PlyHeader::Type type) {
    const std::size_t size = size_of(type);
    if (rest_.size() < size) fail("it ends early");
    std::array<std::uint8_t, 8> bytes{};
    std::memcpy(bytes.data(), rest_.data(), size);
    if (encoding_ == PlyHeader::Encoding::big_endian) {
      std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    }
    rest_.remove_prefix(size);
    switch (type) {
      case PlyHeader::Type::int8:
        return value_of<std::int8_t>(bytes);
      case PlyHeader::Type::uint8:
        return value_of<std::uint8_t>(bytes);
      case PlyHeader::Type::int16:
        return value_of<std::int16_t>(bytes);
      case PlyHeader::Type::uint16:
        return value_of<std::uint16_t>(bytes);
      case PlyHeader::Type::int32:
        return value_of<std::int32_t>(bytes);
      case PlyHeader::Type::uint32:
        return value_of<std::uint32_t>(bytes);
      case PlyHeader::Type::float32:
        return value_of<float>(bytes);
      case PlyHeader::Type::float64:
        return value_of<double>(bytes);
    }
    return 0;
  }

  std::string_view rest_;
  PlyHeader::Encoding encoding_;
  const std::string& label_;
};

/// The attributes of a vertex, by the names that are in use for each.
enum Slot { px, py, pz, nx, ny, nz, tu, tv, cr, cg, cb, slots };
constexpr std::array<std::array<std::string_view, 3>, slots> slot_names{{{"x", "", ""},
                                                                         {"y", "", ""},
                                                                         {"z", "", ""},
                                                                         {"nx", "", ""},
                                                                         {"ny", "", ""},
                                                                         {"nz", "", ""},
                                                                         {"u", "s", "texture_u"},
                                                                         {"v", "t", "texture_v"},
                                                                         {"r", "red", ""},
                                                                         {"g", "green", ""},
                                                                         {"b", "blue", ""}}};

std::optional<std::size_t> slot_of(std::string_view name) {
  for (std::size_t s = 0; s < slots; ++s) {
    for (const std::string_view n : slot_names[s]) {
      if (!n.empty() && n == name) return s;
    }
  }
  return {};
}

/// The largest value of an integer type; 1 for floats.
double largest(PlyHeader::Type type) {
  switch (type) {
    case PlyHeader::Type::int8:
      return 127;
    case PlyHeader::Type::uint8:
      return 255;
    case PlyHeader::Type::int16:
      return 32767;
    case PlyHeader::Type::uint16:
      return 65535;
    case PlyHeader::Type::int32:
      return 2147483647.0;
    case PlyHeader::Type::uint32:
      return 4294967295.0;
    default:
      return 1;
  }
}

void skip(PlyValues& values, const PlyHeader::Property& p) {
  const std::uint64_t n = p.list ? values.length(p.length_type) : 1;
  for (std::uint64_t i = 0; i < n; ++i) values.next(p.type);
}

void read_vertices(PlyValues& values, const PlyHeader::Element& element, ImportedMesh& mesh,
                   std::vector<std::string>* skipped) {
  std::vector<std::optional<std::size_t>> places;
  std::array<bool, slots> has{};
  for (const auto& p : element.properties) {
    places.push_back(p.list ? std::nullopt : slot_of(p.name));
    if (places.back()) has[*places.back()] = true;
    if (!places.back() && skipped != nullptr) skipped->push_back("vertex property " + p.name);
  }
  if (!has[px] || !has[py] || !has[pz]) values.fail("its vertices have no x, y and z");
  const bool normals = has[nx] && has[ny] && has[nz], uvs = has[tu] && has[tv],
             colors = has[cr] && has[cg] && has[cb];
  for (std::uint64_t i = 0; i < element.count; ++i) {
    std::array<float, slots> v{};
    for (std::size_t k = 0; k < places.size(); ++k) {
      const auto& p = element.properties[k];
      if (!places[k]) {
        skip(values, p);
        continue;
      }
      const double value = values.next(p.type);
      v[*places[k]] = static_cast<float>(*places[k] >= cr ? value / largest(p.type) : value);
    }
    mesh.positions.emplace_back(v[px], v[py], v[pz]);
    if (normals) mesh.normals.emplace_back(v[nx], v[ny], v[nz]);
    if (uvs) mesh.uvs.emplace_back(v[tu], v[tv]);
    if (colors) mesh.colors.emplace_back(v[cr], v[cg], v[cb]);
  }
}

std::uint32_t index_of(PlyValues& values, PlyHeader::Type type, std::size_t vertices) {
  const double i = values.next(type);
  if (!(i >= 0 && i < static_cast<double>(vertices) && i == std::floor(i))) {
    values.fail(fmt::format("a face names vertex {}; allowed: 0 to {}", i,
                            static_cast<double>(vertices) - 1));
  }
  return static_cast<std::uint32_t>(i);
}

void read_faces(PlyValues& values, const PlyHeader::Element& element, ImportedMesh& mesh,
                std::vector<std::string>* skipped) {
  const auto is_index = [](const PlyHeader::Property& p) {
    return p.list && (p.name == "vertex_indices" || p.name == "vertex_index");
  };
  if (std::none_of(element.properties.begin(), element.properties.end(), is_index)) {
    values.fail("its faces have no list vertex_indices");
  }
  if (skipped != nullptr) {
    for (const auto& p : element.properties) {
      if (!is_index(p)) skipped->push_back("face property " + p.name);
    }
  }
  for (std::uint64_t i = 0; i < element.count; ++i) {
    for (const auto& p : element.properties) {
      if (!is_index(p)) {
        skip(values, p);
        continue;
      }
      const std::uint64_t corners = values.length(p.length_type);
      std::uint32_t first = 0, last = 0;
      for (std::uint64_t c = 0; c < corners; ++c) {
        const std::uint32_t v = index_of(values, p.type, mesh.positions.size());
        if (c == 0) first = v;
        if (c >= 2) mesh.triangles.push_back({first, last, v});
        last = v;
      }
    }
  }
}

}  // namespace

ImportedMesh ply_mesh(std::span<const std::uint8_t> file, const std::string& label,
                      std::vector<std::string>* skipped) {
  const PlyHeader header = read_ply_header(file, label);
  PlyValues values(file.subspan(header.bytes), header.encoding, label);
  ImportedMesh mesh;
  for (const auto& element : header.elements) {
    if (element.name == "vertex") {
      if (element.count > 0xFFFFFFFEU) values.fail("it has more than 2^32 - 2 vertices");
      read_vertices(values, element, mesh, skipped);
    } else if (element.name == "face") {
      read_faces(values, element, mesh, skipped);
    } else {
      if (skipped != nullptr) skipped->push_back("element " + element.name);
      for (std::uint64_t i = 0; i < element.count; ++i) {
        for (const auto& p : element.properties) skip(values, p);
      }
    }
  }
  return mesh;
}

}  // namespace lacuna
