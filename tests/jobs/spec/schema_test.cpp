#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "all_types.h"
#include "base/json/json_text.h"
#include "jobs/spec/job_json.h"
#include "jobs/spec/json_writer.h"
#include "jobs/spec/problems.h"
#include "jobs/spec/published.h"
#include "mini_schema.h"
#include "random_settings.h"

namespace lacuna {
namespace {

using Json = nlohmann::json;

const Json& schema() {
  static const Json parsed = parse_own_sorted(job_schema());
  return parsed;
}

/// Walks tables and schema side by side: every key of every table is there with its default, its
/// documentation and its unit, and the default is allowed by the key's own schema.
class TableCheck {
 public:
  explicit TableCheck(const Json& object) : object_(object) {}

  template <class T>
  void operator()(std::string_view name, T& member, const Field& field) {
    SCOPED_TRACE(std::string(name));
    ++count_;
    ASSERT_TRUE(object_["properties"].contains(name));
    const Json& property = object_["properties"][std::string(name)];
    const std::string text = property["description"];
    EXPECT_EQ(text.find(field.doc), 0u);
    EXPECT_NE(text.find(field.unit), std::string::npos);
    const auto& required = object_["required"];
    EXPECT_EQ(std::find(required.begin(), required.end(), name) != required.end(), field.required);
    if (field.required) {
      EXPECT_FALSE(property.contains("default"));
    } else {
      ASSERT_TRUE(property.contains("default"));
      EXPECT_EQ(json_text(property["default"]), json_text(Json(ObjectWriter::value_of(member))));
      EXPECT_TRUE(MiniSchema::accepts(property, property["default"]));
    }
    if (!field.published.empty()) {
      const Json published = parse_own_sorted(field.published);
      EXPECT_TRUE(MiniSchema::accepts(property, published));
      EXPECT_NE(published, Json(ObjectWriter::value_of(member)));
      EXPECT_NE(text.find(fmt::format("as published: `{}`", field.published)), std::string::npos);
    }
    descend(property, member);
  }

  /// Nothing else is there, but "as" where there are published values.
  void check_count() const {
    const bool as = object_["properties"].contains(values_key);
    EXPECT_EQ(as, json_text(object_).find("as published: ") != std::string::npos);
    EXPECT_EQ(object_["properties"].size(), count_ + (as ? 1 : 0));
  }

 private:
  template <class T>
  static void descend(const Json& property, T& member) {
    if constexpr (is_optional<T>) {
      typename T::value_type inner{};
      descend(property, inner);
    } else if constexpr (is_variant<T>) {
      descend_choice(property, &member);
    } else if constexpr (Described<T>) {
      EXPECT_EQ(property["additionalProperties"], false);
      TableCheck check(property);
      describe(check, member);
      check.check_count();
    }
  }

  template <class... Ts>
  static void descend_choice(const Json& property, const std::variant<Ts...>*) {
    std::size_t i = 0;
    const auto check_one = [&]<class T>(T settings) {
      SCOPED_TRACE(std::string(T::name));
      const Json& choice = property["oneOf"][i++];
      EXPECT_EQ(choice["title"], T::name);
      EXPECT_EQ(choice["description"], T::doc);
      EXPECT_EQ(choice["properties"]["type"]["const"], T::name);
      EXPECT_EQ(choice["required"][0], "type");
      TableCheck check(choice);
      ++check.count_;  // "type"
      describe(check, settings);
      check.check_count();
    };
    (check_one(Ts{}), ...);
  }

  const Json& object_;
  std::size_t count_ = 0;
};

TEST(Schema, HoldsEveryTable) {
  EXPECT_EQ(schema()["$schema"], "https://json-schema.org/draft/2020-12/schema");
  EXPECT_EQ(schema()["additionalProperties"], false);
  JobSpec defaults;
  TableCheck check(schema());
  describe(check, defaults);
  check.check_count();
}

TEST(Schema, StatesRangesAndNames) {
  const Json& keys = schema()["properties"];
  EXPECT_EQ(keys["resolution"]["items"]["minimum"], 1);
  EXPECT_EQ(keys["resolution"]["items"]["maximum"], 16384);
  EXPECT_EQ(keys["resolution"]["minItems"], 2);
  EXPECT_EQ(keys["budget"]["properties"]["seconds"]["exclusiveMinimum"], 0);
  EXPECT_EQ(json_text(keys["seed"]["maximum"]), "9007199254740991");
  EXPECT_EQ(keys["pixel_filter"]["enum"], (Json{"box", "tent"}));
  EXPECT_EQ(keys["pixel_type"]["enum"], (Json{"float", "half"}));
  EXPECT_EQ(keys["scene"]["minLength"], 1);
}

bool reader_accepts(const Json& job) {
  try {
    parse_job(json_text(job));
    return true;
  } catch (const BadJob&) {
    return false;
  }
}

/// Numbers just below, at and above every bound in the schema.
void collect_bounds(const Json& node, std::set<double>& numbers) {
  for (const auto& [key, value] : node.items()) {
    if (value.is_structured()) collect_bounds(value, numbers);
    if (!value.is_number() || (!key.starts_with("m") && !key.starts_with("exc"))) continue;
    const double bound = value.get<double>();
    for (const double x : {bound - 1, bound - 0.5, std::nextafter(bound, -INFINITY), bound,
                           std::nextafter(bound, INFINITY), bound + 1}) {
      numbers.insert(x);
    }
  }
}

std::vector<Json> values_to_try() {
  std::set<double> numbers{-1e300, 1e300, 2147483648.0, -2147483649.0};
  collect_bounds(schema(), numbers);
  std::vector<Json> values{
      nullptr,        true,           Json::array(),     Json::object(),
      Json{1, 2},     Json{1, 2, 3},  Json{0, 0},        Json{"albedo"},
      Json{"a", "b"}, "path",         "inspect",         "bsdf",
      "albedo",       "half",         "est_rmse",        Json{{"type", "path"}},
      std::string(),  Json{{"x", 1}}, Json{{"type", 1}}, Json{{"type", "bsdf"}}};
  for (const std::size_t n : {1, 200, 201, 1024, 1025}) values.emplace_back(std::string(n, 'x'));
  for (const double x : numbers) {
    values.emplace_back(x);
    if (x == std::trunc(x) && std::abs(x) < 1e18) values.emplace_back(static_cast<std::int64_t>(x));
  }
  return values;
}

void collect_pointers(const Json& node, const Json::json_pointer& at,
                      std::vector<Json::json_pointer>& pointers) {
  pointers.push_back(at);
  if (node.is_array()) {
    for (std::size_t i = 0; i < node.size(); ++i) collect_pointers(node[i], at / i, pointers);
  } else if (node.is_object()) {
    for (const auto& [key, value] : node.items()) collect_pointers(value, at / key, pointers);
  }
}

void expect_agreement(const Json& job) {
  ASSERT_EQ(MiniSchema::accepts(schema(), job), reader_accepts(job)) << json_text(job);
}

TEST(Schema, AndReaderAgreeOnEveryValueInEveryPlace) {
  JobSpec path;
  path.scene = "a.glb";
  path.reference = "auto";
  path.budget.iterations = 2;
  path.shards = max_shards;
  path.budget.error = ErrorTarget{ErrorMetric::est_rmse, 1};
  path.environment = EnvironmentSettings{"e.exr", 1, 0};
  JobSpec inspect = path;
  inspect.integrator = InspectSettings{};
  inspect.layers = {ImageLayer::variance, ImageLayer::depth};
  const auto values = values_to_try();
  for (const JobSpec& spec : {path, inspect}) {
    const Json base = parse_own_sorted(write_job(spec));
    ASSERT_TRUE(MiniSchema::accepts(schema(), base));
    std::vector<Json::json_pointer> pointers;
    collect_pointers(base, Json::json_pointer(), pointers);
    for (const auto& at : pointers) {
      for (const Json& value : values) {
        Json job = base;
        job[at] = value;
        expect_agreement(job);
      }
      if (at.empty() || base[at.parent_pointer()].is_array()) continue;
      Json without = base;
      without[at.parent_pointer()].erase(at.back());
      expect_agreement(without);
    }
    for (const auto& at : pointers) {
      if (!base[at].is_object()) continue;
      Json more = base;
      more[at]["unheard_of"] = 1;
      expect_agreement(more);
    }
  }
}

TEST(Schema, AcceptsWhatTheWriterWrites) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const Json job = parse_own_sorted(write_job(random_job(seed)));
    ASSERT_TRUE(MiniSchema::accepts(schema(), job)) << json_text(job);
  }
}

TEST(Documentation, HoldsEveryKeyAndName) {
  const std::string page = job_documentation();
  const auto has = [&](const std::string& text) {
    EXPECT_NE(page.find(text), std::string::npos) << text;
  };
  for (const auto& [key, value] : schema()["properties"].items()) {
    if (key != values_key) has("\n| `" + key + "` | ");
  }
  has("`\"as\": \"published\"`");
  for (const auto& v : EnumTable<ErrorMetric>::values) {
    has("- `" + std::string(v.name) + "`: " + std::string(v.doc) + "\n");
  }
  has("\n## integrator: path\n");
  has("\n## integrator.guide: bsdf\n");
  has("\n## budget.error\n");
  has("| `resolution` | list of 2, each: integer from 1 to 16384 pixels | `[512,512]` | ");
  has("| `scene` | string of 1 to 1024 characters | required | ");
  has("| `max_depth` | integer from 1 to 1024 edges | `6` | ");
  has("| `seconds` | number above 0, at most 10000000 s | none | ");
}

TEST(Documentation, TheDefaultBudgetIsTheOneThatIsFilledIn) {
  const std::string doc = schema()["properties"]["budget"]["description"];
  EXPECT_NE(doc.find(std::to_string(int(Budget::default_seconds)) + " seconds"), std::string::npos);
}

}  // namespace
}  // namespace lacuna
