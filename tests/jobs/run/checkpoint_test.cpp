#include "jobs/run/checkpoint.h"

#include <gtest/gtest.h>
#include <xxhash.h>

#include <optional>

#include "base/parallel/stop.h"
#include "base/storage/atomic_file.h"
#include "renderer/film/layer_means.h"
#include "tests/renderer/gltf/glb_builder.h"

namespace lacuna {
namespace {

using namespace std::string_literals;

const std::string content = "what a picture needs to go on: \0 bytes of any kind"s;

class Checkpoint : public testing::Test {
 protected:
  void write(const std::string& text, const BetweenPieces& between = {}) {
    write_checkpoint(
        file, "key", [&](ByteWriter& out) { out.append(text.data(), text.size()); }, between);
  }
  /// Nothing if there is no file.
  std::optional<std::string> read(const std::string& key = "key",
                                  const BetweenPieces& between = {}) {
    std::string text;
    const auto load = [&](ByteReader& in) {
      text.resize(in.remaining());
      in.read(text.data(), text.size());
    };
    if (!read_checkpoint(file, key, load, between)) return std::nullopt;
    return text;
  }

  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "checkpoint.bin";
};

/// Differs from byte to byte, and is no multiple of anything.
std::string long_content(std::size_t size) {
  std::string text(size, '\0');
  std::uint32_t state = 1;
  for (char& c : text) c = static_cast<char>((state = state * 1664525U + 1013904223U) >> 24U);
  return text;
}

TEST_F(Checkpoint, ComesBack) {
  EXPECT_FALSE(read());
  for (const std::string& text :
       {content, ""s, long_content(piece_bytes), long_content(3 * piece_bytes + 12345)}) {
    write(text);
    EXPECT_EQ(read(), text) << text.size();
  }
}

TEST_F(Checkpoint, IsAsItWasWrittenInOnePiece) {
  write(content);
  ByteWriter expected;
  expected.put(std::string_view("lacuna-checkpoint-5"));
  expected.put(std::string_view("key"));
  expected.put(std::uint64_t{XXH3_64bits(content.data(), content.size())});
  expected.put(std::string_view(content));
  EXPECT_EQ(read_file(file, 1 << 20), expected.bytes());
}

TEST_F(Checkpoint, OfAnotherPictureIsRefused) {
  write(content);
  EXPECT_THROW(read("other"), std::runtime_error);
}

TEST_F(Checkpoint, WhatIsNotReadToItsEndIsRefused) {
  write(content);
  EXPECT_THROW(read_checkpoint(file, "key", [](ByteReader& in) { in.get<char>(); }),
               std::runtime_error);
}

TEST_F(Checkpoint, EveryDamagedByteAndEveryCutIsSeen) {
  write(content);
  const std::string whole = read_file(file, 1 << 20);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x40);
    write_file_atomically(file, damaged, false);
    EXPECT_THROW(read(), std::runtime_error) << "byte " << i;
    write_file_atomically(file, whole.substr(0, i), false);
    EXPECT_THROW(read(), std::runtime_error) << "cut at " << i;
  }
  write_file_atomically(file, whole + "x", false);
  EXPECT_THROW(read(), std::runtime_error);
}

TEST_F(Checkpoint, DamageInAnyPieceIsSeenBeforeAnythingIsLoaded) {
  write(long_content(3 * piece_bytes + 12345));
  const std::string whole = read_file(file, 1 << 24);
  for (std::size_t i = whole.size() % 4096; i < whole.size(); i += whole.size() / 7) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 1);
    write_file_atomically(file, damaged, false);
    bool loaded = false;
    EXPECT_THROW(read_checkpoint(file, "key", [&](ByteReader&) { loaded = true; }),
                 std::runtime_error);
    EXPECT_FALSE(loaded) << "byte " << i;
  }
}

TEST_F(Checkpoint, WritingThatIsStoppedLeavesTheOneBefore) {
  write(content);
  for (const int pieces : {1, 2, 4}) {  // the last of 4: all is written, but not named
    int left = pieces;
    const auto stop = [&] {
      if (--left == 0) throw Stopped{};
    };
    EXPECT_THROW(write(long_content(3 * piece_bytes + 5), stop), Stopped);
    EXPECT_EQ(left, 0);
    EXPECT_EQ(read(), content);
    EXPECT_EQ(names_in(folder.path()), std::set<std::string>{"checkpoint.bin"});
  }
}

TEST_F(Checkpoint, ReadingCanBeStopped) {
  write(long_content(3 * piece_bytes + 5));
  EXPECT_THROW(read("key", [] { throw Stopped{}; }), Stopped);
}

TEST(CheckpointPieces, LayersNeedTheMemoryOfOne) {
  constexpr std::size_t layers = 40, values = 64 * 64 * 3;
  LayerMeans means(std::vector<std::string>(layers, "a"), 64, 64, 1 << 30);
  std::size_t largest = 0, kept = 0;
  std::string all;
  ByteWriter out([&](std::string_view piece) {
    largest = std::max(largest, piece.size());
    kept = std::max(kept, out.bytes().capacity());
    all += piece;
  });
  means.save(out);
  out.flush();
  EXPECT_LE(largest, piece_bytes);
  EXPECT_LE(kept, 2 * piece_bytes);  // a string doubles
  ASSERT_EQ(all.size(), layers * (sizeof(std::uint64_t) + values * sizeof(double)));
  std::size_t asked = 0, at = 0;
  ByteReader in(all.size(), [&](char* to, std::size_t n) {
    asked = std::max(asked, n);
    all.copy(to, n, at);
    at += n;
  });
  means.load(in, 1);
  EXPECT_TRUE(in.at_end());
  EXPECT_LE(asked, piece_bytes);
  EXPECT_THROW(in.get<char>(), std::runtime_error);
}

}  // namespace
}  // namespace lacuna
