#include <sys/types.h>

#include <algorithm>

#include "analysis/artefacts/codec.h"
#include "analysis/artefacts/entry_file.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

// An entry of the artefact cache. The bytes are read as a whole file, where the checksum stops
// nearly all of them; behind a right header and under a right checksum as packed content, and as
// content that was packed as it should be. Each kind of artefact is tried: refused, or a value
// that is written as it was read.

namespace lacuna::fuzz {
namespace {

const ArtefactKey& key() {
  static const ArtefactKey once = ArtefactKey("numbers", 1).from("geometry", "00ff");
  return once;
}

std::string packed(const std::function<void(ArtefactWriter&)>& write) {
  return pack_entry(key(), "a scene", write);
}

/// The bytes of a file up to its content.
std::size_t head_bytes() {
  static const std::size_t once = [] {
    const std::string entry = packed([](ArtefactWriter&) {});
    EntryHeader header;
    const InputFile file("entry");
    const std::span bytes(reinterpret_cast<const std::uint8_t*>(entry.data()), entry.size());
    expect(!read_entry_header(file.holding(bytes), header), "an own entry can be read");
    return entry.size() - header.packed_bytes;
  }();
  return once;
}

/// Reads a file as a T; what is accepted is written as it was.
template <class T>
void read_as(const std::filesystem::path& file) {
  std::optional<T> value;
  EntryHeader header;
  const auto refusal =
      read_entry(file, key(), header, [&](ArtefactReader& in) { value = decode<T>(in); });
  if (refusal) return;
  std::uint64_t bytes = 0;
  packed([&](ArtefactWriter& out) {
    encode(out, *value);
    bytes = out.written();
  });
  expect(bytes == header.content_bytes, "what is read is written as it was");
}

void read_as_each(std::string_view bytes) {
  static const InputFile input("entry.artefact");
  const auto& file =
      input.holding({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  EntryHeader header;
  read_entry_header(file, header);
  verify_entry(file, header);
  read_as<std::vector<std::uint32_t>>(file);
  read_as<std::string>(file);
  read_as<Grid3<float>>(file);
  read_as<BitGrid3>(file);
  read_as<GridTransform>(file);
  read_as<SkeletonGraph>(file);
}

std::string make_own_entry(std::size_t kind) {
  const SkeletonGraph graph{{{0, 0, 0}, {1, 0, 0}}, {1, 2}, {0, 1, 2}, {1, 0}};
  Grid3<float> grid(Imath::V3i(3, 2, 1));
  for (std::size_t i = 0; i < grid.count(); ++i) grid[i] = static_cast<float>(i);
  BitGrid3 bits(Imath::V3i(9, 2, 1));
  bits.set(8, 1, 0);
  return packed([&](ArtefactWriter& out) {
    if (kind == 0) encode(out, std::vector<std::uint32_t>{3, 1, 4});
    if (kind == 1) encode(out, graph);
    if (kind == 2) encode(out, grid);
    if (kind == 3) encode(out, bits);
    if (kind == 4) encode(out, GridTransform{});
  });
}

/// An entry of today's layout of each kind, so that no stored one can be out of date.
const std::string& own_entry(std::size_t kind) {
  static const auto entries = [] {
    std::array<std::string, 5> all;
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = make_own_entry(i);
    return all;
  }();
  return entries[kind];
}

}  // namespace
}  // namespace lacuna::fuzz

/// A short input becomes an own entry, or its packed content behind a byte that is none of a
/// file's.
LACUNA_FUZZ_MUTATOR(cache_entry) {
  using namespace lacuna::fuzz;
  if (size < 8 && max_size > 512) {
    std::string start = own_entry(seed % 5);
    if (seed % 2 == 0) start = "\1" + start.substr(head_bytes());
    std::copy(start.begin(), start.end(), data);
    size = start.size();
  }
  return LLVMFuzzerMutate(data, size, max_size);
}

/// The first byte of an input chooses how it is read: that of a file of ours, as a file.
LACUNA_FUZZ_TARGET(cache_entry) {
  using namespace lacuna::fuzz;
  if (size == 0) return 0;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const std::string rest = bytes.substr(1);
  if (bytes[0] == own_entry(0)[0]) {
    read_as_each(bytes);
  } else if (data[0] % 2 == 1) {
    // The size of the content is a part of what is tried.
    std::string entry = own_entry(0).substr(0, head_bytes()) + rest;
    lacuna::seal_entry(entry, std::uint64_t{data[0]} / 2 * 4 + 20);
    read_as_each(entry);
  } else {
    read_as_each(
        packed([&](lacuna::ArtefactWriter& out) { out.append(rest.data(), rest.size()); }));
  }
  return 0;
}
