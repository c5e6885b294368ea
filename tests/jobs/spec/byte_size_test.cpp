#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "jobs/spec/byte_size.h"

namespace lacuna {
namespace {

TEST(ByteSize, ReadsBytesAndPowersOf1024) {
  EXPECT_EQ(parse_byte_size("0"), 0u);
  EXPECT_EQ(parse_byte_size("1073741824"), 1u << 30);
  EXPECT_EQ(parse_byte_size("64K"), 65536u);
  EXPECT_EQ(parse_byte_size("512M"), 512u << 20);
  EXPECT_EQ(parse_byte_size("4G"), std::uint64_t{4} << 30);
  EXPECT_EQ(parse_byte_size("9223372036854775807"), 9223372036854775807u);
}

TEST(ByteSize, RefusesAllElseAndQuotesIt) {
  for (const char* text : {"", "G", "4g", "4GB", "4 G", "-4G", "+4G", "1.5G", "0x10", "4G ", "4X",
                           "9223372036854775808", "8388608T", "99999999999999999999"}) {
    try {
      parse_byte_size(text);
      ADD_FAILURE() << text;
    } catch (const std::invalid_argument& e) {
      EXPECT_NE(std::string(e.what()).find('"' + std::string(text) + '"'), std::string::npos);
      EXPECT_NE(std::string(e.what()).find("4G"), std::string::npos);
    }
  }
}

TEST(ByteSize, WritesThemForPeople) {
  EXPECT_EQ(byte_size_text(12), "12 bytes");
  EXPECT_EQ(byte_size_text(1536), "1.5 KiB");
  EXPECT_EQ(byte_size_text(std::uint64_t{4} << 30), "4.0 GiB");
  EXPECT_EQ(byte_size_text(std::uint64_t{5000} << 40), "5000.0 TiB");
}

}  // namespace
}  // namespace lacuna
