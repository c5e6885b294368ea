#include <gtest/gtest.h>
#include <sys/stat.h>

#include <random>

#include "analysis/artefacts/codec.h"
#include "base/storage/atomic_file.h"
#include "tests/analysis/artefacts/entries.h"

namespace lacuna {
namespace {

using Numbers = std::vector<std::uint32_t>;
const Numbers numbers{3, 1, 4, 1, 5, 9, 2, 6};

std::string entry_of(const ArtefactKey& key, const Numbers& values = numbers) {
  return pack_entry(key, "a scene", [&](ArtefactWriter& out) { encode(out, values); });
}

/// What reading gives: the numbers, or a refusal.
struct Read {
  std::optional<Numbers> value;
  std::optional<EntryRefusal> refusal;
  EntryHeader header;
};
Read read(const std::filesystem::path& file, const ArtefactKey& key) {
  Read r;
  r.refusal =
      read_entry(file, key, r.header, [&](ArtefactReader& in) { r.value = decode<Numbers>(in); });
  return r;
}

EntryFault fault_of(const std::filesystem::path& file, const ArtefactKey& key) {
  const Read r = read(file, key);
  EXPECT_TRUE(r.refusal);
  if (!r.refusal) return EntryFault{-1};
  EXPECT_FALSE(r.refusal->text.empty());
  return r.refusal->fault;
}

TEST(EntryFile, ComesBackWithAllItSays) {
  const TemporaryFolder tmp;
  const ArtefactKey key = key_of("n=1", 7);
  const auto file = put_entry(tmp.path(), key, entry_of(key));
  const Read r = read(file, key);
  ASSERT_FALSE(r.refusal) << r.refusal->text;
  EXPECT_EQ(r.value, numbers);
  EXPECT_EQ(r.header.type, "numbers");
  EXPECT_EQ(r.header.version, 7u);
  EXPECT_EQ(r.header.key, key.text());
  EXPECT_EQ(r.header.label, "a scene");
  EXPECT_EQ(r.header.content_bytes, 8 + sizeof(std::uint32_t) * numbers.size());
  EntryHeader seen;
  EXPECT_FALSE(verify_entry(file, seen));
  EXPECT_EQ(seen.key, key.text());
  EXPECT_TRUE(is_entry_name(file.filename().string()));
}

TEST(EntryFile, TheSameArtefactHasTheSameBytes) {
  EXPECT_EQ(entry_of(key_of("")), entry_of(key_of("")));
}

TEST(EntryFile, OfAnEarlierBuildIsRead) {
  // If this fails, the layout has changed: count format_version up, and make the files anew.
  const auto folder =
      std::filesystem::path(LACUNA_SOURCE_DIR) / "tests" / "fuzz" / "corpus" / "cache_entry";
  const ArtefactKey key = ArtefactKey("numbers", 1).from("geometry", "00ff");
  const Read r = read(folder / entry_name(key), key);
  ASSERT_FALSE(r.refusal) << r.refusal->text;
  EXPECT_EQ(r.value, (Numbers{3, 1, 4, 1, 5}));
  EXPECT_EQ(r.header.label, "door.glb");
}

TEST(EntryFile, NoDamagedByteAndNoCutIsBelieved) {
  const TemporaryFolder tmp;
  const ArtefactKey key = key_of("");
  const std::string whole = entry_of(key);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    for (const int flip : {0x01, 0x40, 0xff}) {
      std::string damaged = whole;
      damaged[i] = static_cast<char>(damaged[i] ^ flip);
      const auto file = put_entry(tmp.path(), key, damaged);
      EXPECT_TRUE(read(file, key).refusal) << "byte " << i;
      EntryHeader header;
      EXPECT_TRUE(verify_entry(file, header)) << "byte " << i;
    }
    const auto file = put_entry(tmp.path(), key, whole.substr(0, i));
    EXPECT_EQ(fault_of(file, key), EntryFault::cut_short) << "cut at " << i;
  }
  EXPECT_EQ(fault_of(put_entry(tmp.path(), key, whole + "x"), key), EntryFault::damaged);
}

TEST(EntryFile, EachReasonHasItsName) {
  const TemporaryFolder tmp;
  const ArtefactKey key = key_of("n=1");
  const std::string whole = entry_of(key);
  const auto changed = [&](std::size_t at, char to) {
    std::string bytes = whole;
    bytes[at] = to;
    return put_entry(tmp.path(), key, bytes);
  };
  EXPECT_EQ(fault_of(tmp / entry_name(key), key), EntryFault::missing);
  EXPECT_EQ(fault_of(put_entry(tmp.path(), key, std::string(5000, 'x')), key), EntryFault::foreign);
  EXPECT_EQ(fault_of(changed(0, 'x'), key), EntryFault::foreign);
  EXPECT_EQ(fault_of(changed(8, 99), key), EntryFault::other_version);  // the format's
  EXPECT_EQ(fault_of(changed(whole.size() / 2, '~'), key), EntryFault::damaged);
  EXPECT_EQ(fault_of(changed(whole.size() - 1, '~'), key), EntryFault::damaged);
  EXPECT_EQ(fault_of(put_entry(tmp.path(), key, entry_of(key_of("n=2"))), key),
            EntryFault::other_key);
  EXPECT_EQ(fault_of(put_entry(tmp.path(), key, entry_of(key_of("n=1", 2))), key),
            EntryFault::other_version);
  const std::string other = pack_entry(key, "", [](ArtefactWriter& out) { encode(out, 1.0); });
  EXPECT_EQ(fault_of(put_entry(tmp.path(), key, other), key), EntryFault::undecodable);
}

TEST(EntryFile, OnlyRegularFilesAreRead) {
  const TemporaryFolder tmp;
  const ArtefactKey key = key_of("");
  const auto file = tmp / entry_name(key);
  ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
  EXPECT_EQ(fault_of(file, key), EntryFault::unreadable);
  std::filesystem::remove(file);
  std::filesystem::create_directory(file);
  EXPECT_EQ(fault_of(file, key), EntryFault::unreadable);
  std::filesystem::remove(file);
  std::filesystem::create_symlink("elsewhere", file);
  EXPECT_EQ(fault_of(file, key), EntryFault::unreadable);
}

TEST(EntryFile, SizesThatLieAreRefusedThoughTheChecksumIsRight) {
  const TemporaryFolder tmp;
  const ArtefactKey key = key_of("");
  for (const std::uint64_t bytes : {std::uint64_t{0}, std::uint64_t{39}, std::uint64_t{41},
                                    std::uint64_t{1} << 20, ~std::uint64_t{0}}) {
    std::string entry = entry_of(key);
    seal_entry(entry, bytes);
    EXPECT_TRUE(read(put_entry(tmp.path(), key, entry), key).refusal) << bytes;
  }
  // More in a header than there is, or than is ever there.
  for (const std::uint32_t bytes : {0u, 20u, 1u << 16, 1u << 30}) {
    std::string entry = entry_of(key);
    std::memcpy(entry.data() + 12, &bytes, sizeof bytes);
    EXPECT_TRUE(read(put_entry(tmp.path(), key, entry), key).refusal) << bytes;
  }
}

TEST(EntryFile, NoMutationDoesHarmThoughTheChecksumIsRight) {
  const TemporaryFolder tmp;
  const ArtefactKey key = key_of("");
  const std::string whole = entry_of(key, Numbers(100, 7));
  EntryHeader header;
  ASSERT_FALSE(read_entry_header(put_entry(tmp.path(), key, whole), header));
  const std::size_t content = whole.size() - header.packed_bytes;
  std::mt19937 random(3);
  for (int round = 0; round < 500; ++round) {
    std::string entry = whole;
    for (int k = 0; k < 1 + round % 3; ++k) {
      entry[content + random() % (entry.size() - content)] = static_cast<char>(random());
    }
    seal_entry(entry, header.content_bytes);
    const Read r = read(put_entry(tmp.path(), key, entry), key);
    if (!r.refusal) {
      EXPECT_EQ(r.value->size(), 100u);
    } else {
      EXPECT_EQ(r.refusal->fault, EntryFault::undecodable) << r.refusal->text;
    }
  }
}

TEST(EntryFile, TheRightBytesUnderAnotherNameAreSeen) {
  const TemporaryFolder tmp;
  const auto file = put_entry(tmp.path(), key_of("n=1"), entry_of(key_of("n=2")));
  EntryHeader header;
  const auto refusal = verify_entry(file, header);
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->fault, EntryFault::other_key);
  for (const char* name : {"", "x.artefact", "0123456789abcdef0123456789abcdeF.artefact",
                           "0123456789abcdef0123456789abcdef.artefact.tmp",
                           "0123456789abcdef0123456789abcde0f.artefact"}) {
    EXPECT_FALSE(is_entry_name(name)) << name;
  }
}

}  // namespace
}  // namespace lacuna
