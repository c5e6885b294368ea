#include <gtest/gtest.h>

#include "server/http/query.h"

#include "server/http/message.h"

namespace lacuna {
namespace {

Query parsed(const std::string& text) { return Query(text); }

void expect_refused(const std::string& text) { EXPECT_THROW(parsed(text), HttpError) << text; }

TEST(Query, DecodesNamesAndValues) {
  const Query query = parsed("st%61te=a%2cb&label=two+words%2B&empty=&bare&sky=%F0%9F%98%80");
  EXPECT_EQ(query.text("state"), "a,b");
  EXPECT_EQ(query.text("label"), "two words+");
  EXPECT_EQ(query.text("empty"), "");
  EXPECT_TRUE(query.has("bare"));
  EXPECT_EQ(query.text("sky"), "\xF0\x9F\x98\x80");
  EXPECT_EQ(query.text("absent"), std::nullopt);
}

TEST(Query, IsStrict) {
  for (const char* text : {"a=%", "a=%1", "a=%g1", "a=%00", "a=%1f", "a=%7F", "a=%80", "a=%c0%af",
                           "a=%e0%80%80", "a=%ed%bf%bf", "a=%f4%90%80%80", "a=%f0%80%80%80",
                           "a=%c2%9f", "=1", "a&&b", "a=1&a=1", "a&a"}) {
    expect_refused(text);
  }
}

TEST(Query, ReadsIntegersInTheirRange) {
  const Query query = parsed("n=-5&big=99999999999999999999&word=5x&none=&plus=%2B5&hex=0x5");
  EXPECT_EQ(query.integer("n"), -5);
  EXPECT_EQ(query.integer("n", -5, -5), -5);
  EXPECT_EQ(query.integer("absent", 1, 2), std::nullopt);
  EXPECT_THROW(query.integer("n", -4, 9), HttpError);
  EXPECT_THROW(query.integer("n", -9, -6), HttpError);
  for (const char* name : {"big", "word", "none", "plus", "hex"}) {
    EXPECT_THROW(query.integer(name), HttpError) << name;
  }
}

TEST(Query, ReadsFlags) {
  const Query query = parsed("a=1&b=true&c=0&d=false&e=yes&f");
  EXPECT_TRUE(query.flag("a") && query.flag("b"));
  EXPECT_FALSE(query.flag("c") || query.flag("d") || query.flag("absent"));
  EXPECT_THROW(query.flag("e"), HttpError);
  EXPECT_THROW(query.flag("f"), HttpError);
}

TEST(Query, NamesWhatIsKnown) {
  const Query query = parsed("limit=1&lmit=2");
  EXPECT_NO_THROW(query.check_known({"lmit", "limit"}));
  try {
    query.check_known({"state", "limit"});
    FAIL();
  } catch (const HttpError& error) {
    EXPECT_STREQ(error.what(), "unknown query parameter \"lmit\"; known: state, limit");
    EXPECT_EQ(error.status(), 400);
  }
}

}  // namespace
}  // namespace lacuna
