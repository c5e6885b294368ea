#include <gtest/gtest.h>

#include "analysis/artefacts/key.h"
#include "analysis/artefacts/settings_text.h"
#include "analysis/settings/analysis_settings.h"
#include "tests/temporary_folder.h"

namespace lacuna {

enum class Rule { fast, exact };
template <>
struct EnumTable<Rule> {
  static constexpr std::array<EnumValue<Rule>, 2> values{
      {{Rule::fast, "fast", ""}, {Rule::exact, "exact", ""}}};
};

namespace {

struct Options {
  double share = 0.1;
  bool pierce = true;
  Rule rule = Rule::exact;
};
template <class V>
void describe(V& v, Options& s) {
  v("share", s.share, {.doc = ""});
  v("pierce", s.pierce, {.doc = ""});
  v("rule", s.rule, {.doc = ""});
}

TEST(ArtefactKey, SaysAllThatItIsOf) {
  const auto domain = ArtefactKey("domain", 2).from("geometry", "00ff");
  EXPECT_EQ(domain.text(), "domain 2 {} geometry:00ff");
  const auto skeleton = ArtefactKey("skeleton", 3, "resolution=128").from(domain);
  EXPECT_EQ(skeleton.text(), "skeleton 3 {resolution=128} domain:" + domain.hash());
  EXPECT_EQ(skeleton.hash(), key_hash(skeleton.text()));
}

TEST(ArtefactKey, EachPartCounts) {
  const auto base = [] { return ArtefactKey("a", 1, "x=1").from("g", "01").from("h", "02"); };
  const std::set<std::string> hashes{
      base().hash(),
      ArtefactKey("b", 1, "x=1").from("g", "01").from("h", "02").hash(),
      ArtefactKey("a", 2, "x=1").from("g", "01").from("h", "02").hash(),
      ArtefactKey("a", 1, "x=2").from("g", "01").from("h", "02").hash(),
      ArtefactKey("a", 1, "x=1").from("g", "03").from("h", "02").hash(),
      ArtefactKey("a", 1, "x=1").from("h", "02").from("g", "01").hash(),
      ArtefactKey("a", 1, "x=1").from("g", "01").hash(),
      ArtefactKey("a", 1, "x=1 g:01").from("h", "02").hash()};
  EXPECT_EQ(hashes.size(), 8u);
  for (const std::string& hash : hashes) EXPECT_EQ(hash.size(), 32u);
}

TEST(ArtefactKey, IsTheSameInEveryBuild) {
  // A constant: entries that were written years ago are found again.
  EXPECT_EQ(key_hash(""), "99aa06d3014798d86001c324468d497f");
}

TEST(ArtefactKey, RefusesWhatWouldBeAmbiguous) {
  for (const char* type : {"", "Skeleton", "1a", "a b", "a:b", "a-b"}) {
    EXPECT_TRUE(contains(message_of<std::invalid_argument>([&] { ArtefactKey key(type, 1); }),
                         "lower-case"))
        << type;
  }
  for (const char* settings : {"{", "a}", "a\nb", "\x7f", "\xc3\xa4"}) {
    EXPECT_THROW(ArtefactKey("a", 1, settings), std::invalid_argument) << settings;
  }
  for (const char* hash : {"", "0g", "AB", "0 1"}) {
    EXPECT_THROW(ArtefactKey("a", 1).from("g", hash), std::invalid_argument) << hash;
  }
  EXPECT_THROW(ArtefactKey("a", 1).from("", "01"), std::invalid_argument);
}

TEST(SettingsText, NamesEveryFieldExactly) {
  EXPECT_EQ(settings_text(Options{}), "share=0.1 pierce=true rule=exact");
  EXPECT_EQ(settings_text(Options{1.0 / 3, false, Rule::fast}),
            "share=0.3333333333333333 pierce=false rule=fast");
  EXPECT_EQ(settings_text(AnalysisSettings{.resolution = 64}),
            "resolution=64 distance=l1 mapping=geodesic cluster_alpha=0.2 regions=forest "
            "node_radius=corner");
  EXPECT_NO_THROW(ArtefactKey("a", 1, settings_text(Options{})));
}

}  // namespace
}  // namespace lacuna
