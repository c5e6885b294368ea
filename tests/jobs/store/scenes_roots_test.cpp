#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <algorithm>
#include <stdexcept>

#include "base/storage/passing_error.h"
#include "jobs/store/job_folder.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;
const std::vector<std::string_view> scenes{".glb", ".gltf"};

/// root/ with scenes, a secret outside it, and every way to reach the secret.
class ScenesRootsTest : public testing::Test {
 protected:
  void SetUp() override {
    put_file(root_ / "box.glb", "box");
    put_file(root_ / "door" / "scene.glb", "door");
    put_file(root_ / "door" / "Sky.EXR", "sky");
    put_file(root_ / "door" / "notes.txt", "notes");
    put_file(root_ / ".hidden" / "x.glb", "x");
    put_file(tmp_ / "secret.glb", "secret");
    put_file(tmp_.path() / "outside" / "secret.glb", "secret");
    fs::create_symlink(tmp_ / "secret.glb", root_ / "link.glb");
    fs::create_symlink("box.glb", root_ / "inner.glb");
    fs::create_directory_symlink(tmp_ / "outside", root_ / "way");
    fs::create_directory(root_ / "folder.glb");
    ASSERT_EQ(::mkfifo((root_ / "fifo.glb").c_str(), 0600), 0);
  }

  std::string refusal(std::string_view name) const {
    return message_of<std::invalid_argument>([&] { roots_.resolve(name, scenes); });
  }

  const TemporaryFolder tmp_;
  const fs::path root_ = tmp_ / "root";
  const ScenesRoots roots_{{root_}};
};

TEST_F(ScenesRootsTest, FindsFilesOfTheWantedKind) {
  EXPECT_EQ(roots_.resolve("box.glb", scenes), root_ / "box.glb");
  EXPECT_EQ(roots_.resolve("door/scene.glb", scenes), root_ / "door/scene.glb");
  EXPECT_EQ(roots_.resolve("door/Sky.EXR", {".exr", ".hdr"}), root_ / "door/Sky.EXR");
  EXPECT_EQ(roots_.resolve(".hidden/x.glb", scenes), root_ / ".hidden/x.glb");
}

TEST_F(ScenesRootsTest, ANameCannotLeaveItsRootInAnySpelling) {
  const std::string absolute = (tmp_ / "secret.glb").string();
  for (const std::string& name :
       {std::string(), std::string("../secret.glb"), std::string("door/../../secret.glb"),
        std::string("door/../box.glb"), std::string("./box.glb"), std::string("door/./scene.glb"),
        std::string("door//scene.glb"), std::string("box.glb/"), std::string("/box.glb"), absolute,
        "/" + absolute, std::string("door\\scene.glb"), std::string("..\\secret.glb"),
        std::string("box.glb\0", 8), std::string("../secret.glb\0.glb", 18),
        std::string("box.glb\n"), std::string("\x7f.glb"), std::string("..")}) {
    const std::string message = refusal(name);
    EXPECT_TRUE(contains(message, "it ")) << message;
    EXPECT_FALSE(contains(message, "it does not exist")) << message;  // refused before any look-up
  }
}

TEST_F(ScenesRootsTest, NoLinkIsFollowed) {
  for (const char* name : {"link.glb", "inner.glb", "way/secret.glb"}) {
    EXPECT_TRUE(contains(refusal(name), "symbolic link")) << name;
  }
}

TEST_F(ScenesRootsTest, OnlyRegularFilesOfTheWantedKindAreFound) {
  EXPECT_TRUE(contains(refusal("folder.glb"), "regular file"));
  EXPECT_TRUE(contains(refusal("fifo.glb"), "regular file"));
  EXPECT_TRUE(contains(refusal("door/notes.txt"), "does not end in .glb or .gltf"));
  EXPECT_TRUE(contains(refusal(".glb"), "does not end in .glb or .gltf"));
  EXPECT_TRUE(contains(refusal("box.glb/scene.glb"), "does not exist"));
}

TEST_F(ScenesRootsTest, ARefusalSaysWhatThereIs) {
  const std::string message = refusal("door/scen.glb");
  EXPECT_TRUE(contains(message, "\"door/scen.glb\"")) << message;
  EXPECT_TRUE(contains(message, "did you mean \"door/scene.glb\"?")) << message;
  EXPECT_TRUE(contains(message, "box.glb, door/scene.glb")) << message;
  EXPECT_FALSE(contains(message, "link")) << message;
  EXPECT_FALSE(contains(message, tmp_.path().string())) << message;
  EXPECT_TRUE(contains(
      message_of<std::invalid_argument>([] { ScenesRoots({}).resolve("box.glb", scenes); }),
      "there is no .glb, .gltf file below the scenes roots"));
}

TEST_F(ScenesRootsTest, ARefusedNameIsShownSafely) {
  EXPECT_TRUE(contains(refusal("a\x1b[2J.glb"), "\"a?[2J.glb\""));
  EXPECT_LT(refusal(std::string(100000, 'x') + ".glb").size(), 1000u);
}

TEST_F(ScenesRootsTest, TheFirstRootThatHasTheFileWins) {
  put_file(tmp_.path() / "second" / "box.glb", "other");
  put_file(tmp_.path() / "second" / "more.glb", "more");
  const ScenesRoots both({root_, tmp_ / "missing", tmp_ / "second"});
  EXPECT_EQ(both.resolve("box.glb", scenes), root_ / "box.glb");
  EXPECT_EQ(both.resolve("more.glb", scenes), tmp_ / "second" / "more.glb");
  EXPECT_EQ(both.list(), (std::vector<std::string>{"box.glb", "door/scene.glb", "more.glb"}));
}

TEST_F(ScenesRootsTest, WhereARootIsMissingOrEmptyNothingIsKnownToBeMissing) {
  const fs::path empty = tmp_ / "empty", missing = tmp_ / "missing";
  fs::create_directory(empty);
  for (const std::vector<fs::path>& away :
       {std::vector{empty}, std::vector{missing}, {root_, empty}, {missing, root_}}) {
    const ScenesRoots roots(away);
    EXPECT_THROW(roots.resolve("away.glb", scenes), InputUnreadable);
    EXPECT_THROW(roots.resolve("door/away.glb", scenes), InputUnreadable);
    EXPECT_THROW(roots.resolve("../away.glb", scenes), std::invalid_argument);
    if (away.size() > 1) {
      EXPECT_EQ(roots.resolve("box.glb", scenes), root_ / "box.glb");
    }
  }
  EXPECT_TRUE(contains(refusal("away.glb"), "it does not exist"));
  fs::create_directory(root_ / "mount");
  EXPECT_TRUE(contains(refusal("mount/away.glb"), "it does not exist"));
}

TEST_F(ScenesRootsTest, TheRootItselfMayBeALink) {
  fs::create_directory_symlink(root_, tmp_ / "alias");
  const ScenesRoots alias({tmp_ / "alias"});
  EXPECT_EQ(alias.resolve("box.glb", scenes), tmp_ / "alias" / "box.glb");
  EXPECT_EQ(alias.list(), roots_.list());
}

TEST_F(ScenesRootsTest, EverythingListedCanBeResolvedAndHiddenThingsAndLinksAreNot) {
  put_file(root_ / "bad\\name.glb", "x");
  put_file(root_ / "bad\nname.glb", "x");
  EXPECT_EQ(roots_.list(), (std::vector<std::string>{"box.glb", "door/scene.glb"}));
  for (const std::string& name : roots_.list()) EXPECT_NO_THROW(roots_.resolve(name, scenes));
}

TEST_F(ScenesRootsTest, ListingIsBounded) {
  put_file(root_ / "1/2/3/deep.gltf", "x");
  put_file(root_ / "1/2/3/4/too_deep.gltf", "x");
  const auto names = roots_.list();
  EXPECT_EQ(std::count(names.begin(), names.end(), "1/2/3/deep.gltf"), 1);
  EXPECT_EQ(names.size(), 3u);
  const fs::path crowd = tmp_ / "crowd";
  for (int i = 0; i < 10100; ++i) put_file(crowd / (std::to_string(i) + ".glb"), "");
  EXPECT_EQ(ScenesRoots({crowd}).list().size(), 10000u);
}

/// Sets a variable for as long as it lives; nullptr: unset.
class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name) {
    const char* old = ::getenv(name);
    if (old != nullptr) old_ = old;
    set(value);
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;
  ~Environment() { set(old_ ? old_->c_str() : nullptr); }

 private:
  void set(const char* value) {
    if (value != nullptr) {
      ::setenv(name_, value, 1);
    } else {
      ::unsetenv(name_);
    }
  }
  const char* name_;
  std::optional<std::string> old_;
};

TEST(Roots, ComeFromTheEnvironment) {
  const Environment scenes_variable("LACUNA_SCENES", "/a:/b/c::");
  EXPECT_EQ(ScenesRoots::from_environment().roots(), (std::vector<fs::path>{"/a", "/b/c"}));
  const Environment data_variable("LACUNA_DATA", "/data");
  EXPECT_EQ(DataRoot::from_environment().jobs(), "/data/jobs");
  EXPECT_EQ(DataRoot::from_environment().references(), "/data/references");
  EXPECT_EQ(DataRoot::from_environment().cache(), "/data/cache");
}

TEST(Roots, TheCacheCanBeElsewhereAndOfAnotherSize) {
  const Environment data_variable("LACUNA_DATA", "/data");
  for (const char* folder : {"/fast/cache", "fast/cache"}) {
    const Environment cache_variable("LACUNA_CACHE", folder);
    EXPECT_EQ(DataRoot::from_environment().cache(), fs::absolute(folder));
    EXPECT_EQ(DataRoot::at("elsewhere").cache(), fs::absolute(folder));
    EXPECT_EQ(DataRoot::from_environment().jobs(), "/data/jobs");
  }
  EXPECT_EQ(DataRoot::at("elsewhere").cache(), fs::absolute("elsewhere/cache"));
  const Environment limit_variable("LACUNA_CACHE_LIMIT", "3M");
  EXPECT_EQ(DataRoot::from_environment().cache_limit, 3u << 20);
  const Environment wrong_variable("LACUNA_CACHE_LIMIT", "3 MB");
  const auto message = message_of<std::invalid_argument>([] { DataRoot::from_environment(); });
  EXPECT_TRUE(contains(message, "LACUNA_CACHE_LIMIT") && contains(message, "\"3 MB\"")) << message;
}

TEST(Roots, HaveDefaults) {
  for (const char* nothing : {static_cast<const char*>(nullptr), ""}) {
    const Environment scenes_variable("LACUNA_SCENES", nothing);
    const Environment data_variable("LACUNA_DATA", nothing);
    const auto roots = ScenesRoots::from_environment().roots();
    ASSERT_FALSE(roots.empty());
    EXPECT_EQ(roots[0], fs::absolute("jobs/scenes"));
    // The scenes of the source tree are found from any folder.
    const fs::path source = fs::path(LACUNA_SOURCE_DIR) / "jobs/scenes";
    EXPECT_EQ(std::count(roots.begin(), roots.end(), source), fs::exists(source) ? 1 : 0);
    EXPECT_EQ(DataRoot::from_environment().dir, fs::absolute("lacuna-data"));
  }
}

}  // namespace
}  // namespace lacuna
