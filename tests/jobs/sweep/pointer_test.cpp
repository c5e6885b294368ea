#include "jobs/sweep/pointer.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace lacuna {
namespace {

using Tokens = std::vector<std::string>;

TEST(Pointer, TokensAreUnescaped) {
  EXPECT_EQ(pointer_tokens("/integrator/max_depth"), (Tokens{"integrator", "max_depth"}));
  EXPECT_EQ(pointer_tokens("/a~1b/c~0d/~01"), (Tokens{"a/b", "c~d", "~1"}));
  EXPECT_EQ(pointer_tokens("/"), Tokens{""});
}

TEST(Pointer, SetsAKeyThatHasASlash) {
  Json document = Json::object();
  EXPECT_FALSE(set_at(document, Json::object(), "/a~1b", 3));
  EXPECT_EQ(document, (Json{{"a/b", 3}}));
}

}  // namespace
}  // namespace lacuna
