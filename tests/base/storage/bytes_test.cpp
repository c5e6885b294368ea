#include "base/storage/bytes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace lacuna {
namespace {

/// Values of sizes around a piece, in an order in which buffers are full, empty and in between.
const std::vector<std::size_t> sizes{
    0, 3,      piece_bytes - 12, 1, piece_bytes, piece_bytes + 1, 3 * piece_bytes + 7,
    0, 100000, 2 * piece_bytes};

void put_all(ByteWriter& out) {
  for (const std::size_t n : sizes) {
    out.put(std::uint32_t(n));
    out.put(std::vector<char>(n, static_cast<char>(n % 251)));
    out.put(std::string_view("text"));
  }
}

TEST(Bytes, HandedOnInPiecesAreThoseThatAreCollected) {
  ByteWriter all;
  put_all(all);
  all.flush();
  std::string pieces;
  ByteWriter out([&](std::string_view piece) {
    EXPECT_GE(piece.size(), 1U);
    EXPECT_LE(piece.size(), piece_bytes);
    pieces += piece;
  });
  put_all(out);
  out.flush();
  out.flush();
  EXPECT_TRUE(pieces == all.bytes());
}

TEST(Bytes, ReadInPiecesAreThoseThatWereWritten) {
  ByteWriter all;
  put_all(all);
  std::size_t at = 0;
  ByteReader in(all.bytes().size(), [&](char* to, std::size_t n) {
    EXPECT_GE(n, 1U);
    EXPECT_LE(n, piece_bytes);
    ASSERT_EQ(all.bytes().copy(to, n, at), n);
    at += n;
  });
  for (const std::size_t n : sizes) {
    EXPECT_EQ(in.get<std::uint32_t>(), n);
    EXPECT_TRUE(in.get_vector<char>() == std::vector<char>(n, static_cast<char>(n % 251)));
    EXPECT_EQ(in.get_string(), "text");
  }
  EXPECT_TRUE(in.at_end());
  EXPECT_THROW(in.get<char>(), std::runtime_error);
}

TEST(Bytes, ThatEndEarlyAreRefusedBeforeTheyAreAskedFor) {
  std::size_t asked = 0;
  const ByteReader::Source source = [&](char* to, std::size_t n) {
    asked += n;
    std::fill_n(to, n, '\x7f');  // a length that nothing can have
  };
  ByteReader in(3 * piece_bytes, source);
  EXPECT_THROW(in.get_vector<double>(), std::runtime_error);
  std::vector<char> more(3 * piece_bytes);
  EXPECT_THROW(in.read(more.data(), more.size()), std::runtime_error);
  EXPECT_EQ(asked, piece_bytes);
  EXPECT_EQ(in.remaining(), 3 * piece_bytes - 8);
}

}  // namespace
}  // namespace lacuna
