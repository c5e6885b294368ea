#include <gtest/gtest.h>

#include "all_types.h"
#include "expect_problems.h"
#include "jobs/spec/described_json.h"

namespace lacuna {
namespace {

AllTypes read(std::string_view json) { return read_document<AllTypes>(json, {10000, 16}); }

std::vector<Problem> read_problems(const std::string& json) {
  return problems_of([&] { read(json); });
}

TEST(Reader, AnEmptyObjectIsAllDefaults) { EXPECT_EQ(read("{}"), AllTypes{}); }

TEST(Reader, ReadsEveryType) {
  const AllTypes s = read(R"({
    "flag": true, "small": -2147483648, "wide": -9007199254740991, "positive": 9007199254740991,
    "real": 1, "word": "äöü", "colour": "red", "maybe": 2.5, "maybe_colour": "green",
    "maybe_sphere": {"radius": 2}, "maybe_shape": {"type": "box", "maker": "me"}, "found": "auto", "pair": [9, 0],
    "words": ["x", ""], "spheres": [{}, {"radius": 3}], "nested": {},
    "shape": {"type": "box", "size": [0, 10, 5], "maker": "you"}})");
  AllTypes e;
  e.flag = true;
  e.small = std::numeric_limits<int>::min();
  e.wide = -9007199254740991;
  e.positive = 9007199254740991;
  e.real = 1;
  e.word = "äöü";
  e.colour = Colour::red;
  e.maybe = 2.5;
  e.maybe_colour = Colour::green;
  e.maybe_sphere = Sphere{2};
  e.maybe_shape = Box{.size = {1, 2, 3}, .maker = "me"};
  e.found = {};
  e.pair = {9, 0};
  e.words = {"x", ""};
  e.spheres = {Sphere{1}, Sphere{3}};
  e.shape = Box{.size = {0, 10, 5}, .maker = "you"};
  EXPECT_EQ(s, e);
  EXPECT_EQ(read(write_document(s)), s);
}

TEST(Reader, NullIsNoneForWhatIsOptionalAndAnErrorElsewhere) {
  EXPECT_EQ(read(R"({"maybe": null, "maybe_sphere": null, "maybe_shape": null})"), AllTypes{});
  expect_one(read_problems(R"({"real": null})"), "/real", {"found null", "a number from -1 to 1"});
  expect_one(read_problems(R"({"shape": null})"), "/shape", {"found null", "\"sphere\", \"box\""});
}

TEST(Reader, ANameAloneIsAVariantWithItsDefaults) {
  EXPECT_EQ(read(R"({"shape": "sphere"})").shape, (AllTypes{}.shape));
  EXPECT_EQ(std::get<Sphere>(*read(R"({"maybe_shape": "sphere"})").maybe_shape), Sphere{});
  expect_one(read_problems(R"({"shape": "box"})"), "/shape/maker", {"missing", "who made it"});
  expect_one(read_problems(R"({"shape": "bix"})"), "/shape",
             {"string \"bix\"", "did you mean \"box\""});
}

TEST(Reader, AVariantObjectNeedsAKnownType) {
  expect_one(read_problems(R"({"shape": {}})"), "/shape/type",
             {"missing", "\"sphere\"", "\"box\""});
  expect_one(read_problems(R"({"shape": {"type": "cone", "radius": 0}})"), "/shape/type",
             {"string \"cone\"", "\"sphere\", \"box\""});
  expect_one(read_problems(R"({"shape": {"type": 1}})"), "/shape/type", {"number 1"});
  expect_one(read_problems(R"({"shape": {"type": "sphere", "size": [1, 2, 3]}})"), "/shape/size",
             {"unknown key \"size\""});
  expect_one(read_problems(R"({"maybe_shape": {"type": "sphere", "raduis": 1}})"),
             "/maybe_shape/raduis", {"did you mean \"radius\"?"});
}

struct Refused {
  const char* key;
  const char* value;
  const char* pointer;
  std::vector<std::string> parts;
};

TEST(Reader, SaysWhatWasFoundAndWhatIsAllowed) {
  const Refused cases[] = {
      {"found", "9", "/found", {"found number 9", "a number from 0 to 8, or \"auto\""}},
      {"found", "\"never\"", "/found", {"string \"never\"", "or \"auto\""}},
      {"flag", "1", "/flag", {"found number 1", "true or false"}},
      {"flag", "\"true\"", "/flag", {"found string \"true\""}},
      {"small", "1.5", "/small", {"found number 1.5", "an integer from -2147483648 to 2147483647"}},
      {"small", "2147483648", "/small", {"found number 2147483648"}},
      {"small", "-2147483649", "/small", {"found number -2147483649"}},
      {"small", "\"3\"", "/small", {"found string \"3\"", "an integer"}},
      {"small", "true", "/small", {"found true"}},
      {"wide", "9007199254740992", "/wide", {"found number 9007199254740992"}},
      {"wide", "-9007199254740992", "/wide", {"from -9007199254740991 to 9007199254740991"}},
      {"wide", "1e300", "/wide", {"found number 1e+300"}},
      {"positive", "-1", "/positive", {"found number -1", "from 0 to 9007199254740991"}},
      {"positive", "18446744073709551615", "/positive", {"found number 18446744073709551615"}},
      {"positive", "18446744073709551617", "/positive", {"found number 1.8446744073709552e+19"}},
      {"real", "1.0000000000000002", "/real", {"a number from -1 to 1"}},
      {"real", "[]", "/real", {"found a list of 0"}},
      {"word", "\"\"", "/word", {"0 characters", "a string of 1 to 3 characters"}},
      {"word", "\"äöüß\"", "/word", {"4 characters"}},
      {"word", "\"a\\u0000\"", "/word", {"none of them U+0000"}},
      {"word", "{}", "/word", {"found an object"}},
      {"colour", "\"blue\"", "/colour", {"string \"blue\"", "\"red\", \"green\""}},
      {"colour", "\"gren\"", "/colour", {"did you mean \"green\"?"}},
      {"colour", "0", "/colour", {"found number 0"}},
      {"maybe", "1", "/maybe", {"at least 2"}},
      {"maybe_sphere", "{\"radius\": 0}", "/maybe_sphere/radius", {"a number above 0 m"}},
      {"pair", "[1]", "/pair", {"found a list of 1", "a list of exactly 2"}},
      {"pair", "[1, 2, 3]", "/pair", {"found a list of 3"}},
      {"pair", "{}", "/pair", {"found an object"}},
      {"pair", "[0, 10]", "/pair/1", {"found number 10", "from 0 to 9"}},
      {"words", "[\"\", \"\", \"\"]", "/words", {"a list of 3", "a list of at most 2 elements"}},
      {"words", "[\"\", 1]", "/words/1", {"found number 1", "a string"}},
      {"spheres", "[{}, {\"radius\": -1}]", "/spheres/1/radius", {"found number -1"}},
      {"nested", "[]", "/nested", {"found a list of 0", "an object"}},
      {"shape",
       "{\"type\": \"box\", \"maker\": \"\", \"size\": [1, 2, 11]}",
       "/shape/size/2",
       {"found number 11"}},
  };
  for (const Refused& c : cases) {
    SCOPED_TRACE(std::string(c.key) + ": " + c.value);
    expect_one(read_problems("{\"" + std::string(c.key) + "\": " + c.value + "}"), c.pointer,
               c.parts);
  }
}

TEST(Reader, ANumberThatIsAnIntegerMayBeWrittenAsAnyNumber) {
  EXPECT_EQ(read(R"({"small": 1e3})").small, 1000);
  EXPECT_EQ(read(R"({"small": 12.0})").small, 12);
  EXPECT_EQ(read(R"({"positive": -0})").positive, 0u);
  EXPECT_EQ(read(R"({"wide": -1.5e1})").wide, -15);
}

TEST(Reader, FindsAllProblemsAtOnce) {
  const auto found = read_problems(R"({"flag": 0, "small": 1.5, "pair": [-1, 10], "nope": 1})");
  std::vector<std::string> pointers;
  pointers.reserve(found.size());
  for (const Problem& p : found) pointers.push_back(p.pointer);
  EXPECT_EQ(pointers, (std::vector<std::string>{"/flag", "/small", "/pair/0", "/pair/1", "/nope"}));
}

TEST(Reader, PointersAreEscaped) {
  expect_one(read_problems(R"({"a/b~c": 1})"), "/a~1b~0c", {"unknown key \"a/b~c\""});
}

TEST(Reader, LongValuesAreCutInMessages) {
  const auto found = read_problems("{\"word\": \"" + std::string(5000, 'x') + "\"}");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_LT(found[0].message.size(), 200u);
}

TEST(Reader, StopsCountingOutProblemsAtAHundred) {
  std::string json = "{\"x0\": 0";
  for (int i = 1; i < 250; ++i) json += ", \"x" + std::to_string(i) + "\": 0";
  const auto found = read_problems(json + "}");
  ASSERT_EQ(found.size(), 101u);
  EXPECT_EQ(found.back().message, "150 more problems");
}

}  // namespace
}  // namespace lacuna
