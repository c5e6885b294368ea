#include "server/routes/scene_uploads.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <future>
#include <stdexcept>
#include <thread>

#include "tests/failing_files.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;
using Outcome = SceneUploads::Outcome;

fs::path real_renderer() {
  return fs::read_symlink("/proc/self/exe").parent_path() / "../bin/lacuna";
}
std::string scene(const std::string& name) {
  return content_of(fs::path(LACUNA_SOURCE_DIR) / "jobs/scenes" / name);
}

/// A GLB of nothing but JSON.
std::string glb(std::string json) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto word = [](std::size_t n) {
    const auto value = static_cast<std::uint32_t>(n);
    return std::string(reinterpret_cast<const char*>(&value), sizeof value);
  };
  return "glTF" + word(2) + word(20 + json.size()) + word(json.size()) + "JSON" + json;
}

class Uploads : public testing::Test {
 protected:
  /// Without a limit of memory by preset: a renderer with sanitizers takes more than any.
  SceneUploads make(const fs::path& renderer = real_renderer(), std::uint64_t memory = 0) const {
    return SceneUploads(
        {.folder = folder, .renderer = renderer, .limits = {.memory_bytes = memory}});
  }
  fs::path script(const std::string& text) const {
    fs::path program = temp.write("renderer", "#!/bin/sh\n" + text);
    fs::permissions(program, fs::perms::owner_all);
    return program;
  }
  static SceneUploads::Result put(SceneUploads& uploads, const std::string& name,
                                  const std::string& body) {
    SceneUploads::Draft draft = uploads.begin();
    EXPECT_EQ(::write(draft.fd(), body.data(), body.size()), static_cast<ssize_t>(body.size()));
    return uploads.publish(std::move(draft), name);
  }
  /// Published scenes; and nothing of drafts is left. The root itself is marked by a file.
  std::set<std::string> scenes() const {
    std::set<std::string> names = names_in(folder);
    EXPECT_EQ(names.erase(".uploads"), 1U);
    return names;
  }

  TemporaryFolder temp;
  const fs::path folder = temp / "scenes";
};

TEST_F(Uploads, AGoodSceneGetsItsNameOnceAndIsNeverReplaced) {
  SceneUploads uploads = make();
  const std::string cornell = scene("cornell.glb");
  const auto first = put(uploads, "room.glb", cornell);
  EXPECT_EQ(first.outcome, Outcome::created) << first.reason;
  EXPECT_EQ(first.bytes, cornell.size());
  EXPECT_EQ(content_of(folder / "room.glb"), cornell);
  EXPECT_EQ(put(uploads, "room.glb", cornell).outcome, Outcome::same);
  EXPECT_EQ(put(uploads, "room.glb", scene("point.glb")).outcome, Outcome::conflict);
  EXPECT_EQ(content_of(folder / "room.glb"), cornell);
  EXPECT_EQ(scenes(), std::set<std::string>{"room.glb"});
}

TEST_F(Uploads, AnotherSceneOfTheSameSizeIsAConflict) {
  SceneUploads uploads = make(script("exit 0"));
  const std::string first = "glTF" + std::string(200'000, 'a');  // more than is compared at once
  ASSERT_EQ(put(uploads, "a.glb", first).outcome, Outcome::created);
  for (const std::size_t changed : {std::size_t{4}, first.size() - 1}) {
    std::string other = first;
    other[changed] = 'b';
    EXPECT_EQ(put(uploads, "a.glb", other).outcome, Outcome::conflict) << changed;
  }
  EXPECT_EQ(put(uploads, "a.glb", first).outcome, Outcome::same);
}

TEST_F(Uploads, ASceneThatAnOlderRootHidesIsRefusedUnlessItIsTheSame) {
  const std::string cornell = scene("cornell.glb");
  const fs::path older = temp / "older";
  fs::create_directories(older);
  put_file(older / "room.glb", cornell);
  SceneUploads uploads(
      {.folder = folder, .older = {older}, .renderer = real_renderer(), .limits = {}});
  EXPECT_EQ(put(uploads, "room.glb", scene("point.glb")).outcome, Outcome::conflict);
  EXPECT_EQ(put(uploads, "room.glb", cornell).outcome, Outcome::same);
  EXPECT_TRUE(scenes().empty());
  EXPECT_EQ(put(uploads, "other.glb", cornell).outcome, Outcome::created);
}

TEST_F(Uploads, WhatIsNoSceneIsRefusedWithTheReasonAndLeavesNothing) {
  SceneUploads uploads = make();
  const auto refused = [&](const std::string& body) {
    const auto result = put(uploads, "a.glb", body);
    EXPECT_EQ(result.outcome, Outcome::refused);
    EXPECT_FALSE(contains(result.reason, folder.string())) << result.reason;
    EXPECT_FALSE(contains(result.reason, "lacuna:")) << result.reason;
    return result.reason;
  };
  EXPECT_TRUE(contains(refused(""), "glTF"));
  EXPECT_TRUE(contains(refused(R"({"asset": {"version": "2.0"}})"), "not a GLB"));
  EXPECT_FALSE(refused("glTF but no more than that").empty());
  const std::string cornell = scene("cornell.glb");
  EXPECT_FALSE(refused(cornell.substr(0, cornell.size() / 2)).empty());
  EXPECT_TRUE(scenes().empty());
}

TEST_F(Uploads, ASceneMayNameNoOtherFile) {
  SceneUploads uploads = make();
  put_file(folder / "other.bin", std::string(36, '\0'));
  put_file(temp / "above.bin", std::string(36, '\0'));
  const auto naming = [](const std::string& uri) {
    return glb(R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 36, "uri": ")" + uri +
               R"("}]})");
  };
  for (const std::string uri : {"other.bin", "../other.bin", "../above.bin", "%2e%2e/other.bin",
                                "a.glb", "/etc/hostname"}) {
    const auto result = put(uploads, "a.glb", naming(uri));
    EXPECT_EQ(result.outcome, Outcome::refused) << uri;
    EXPECT_TRUE(contains(result.reason, uri)) << result.reason;
  }
  EXPECT_EQ(scenes(), std::set<std::string>{"other.bin"});
}

TEST_F(Uploads, LinksAreNeitherFollowedNorReplaced) {
  SceneUploads uploads = make();
  const std::string cornell = scene("cornell.glb");
  const fs::path target = put_file(temp / "target.glb", cornell);
  fs::create_symlink(target, folder / "link.glb");
  fs::create_symlink(temp / "nowhere", folder / "dangling.glb");
  EXPECT_EQ(put(uploads, "link.glb", cornell).outcome, Outcome::conflict);
  EXPECT_EQ(put(uploads, "dangling.glb", cornell).outcome, Outcome::conflict);
  EXPECT_FALSE(fs::exists(temp / "nowhere"));
}

TEST_F(Uploads, ACheckThatEndsBadlyRefusesTheScene) {
  const auto reason = [&](const std::string& text) {
    SceneUploads uploads = make(script(text), std::uint64_t{1} << 30);
    const auto result = put(uploads, "a.glb", "glTF");
    EXPECT_EQ(result.outcome, Outcome::refused);
    return result.reason;
  };
  EXPECT_TRUE(contains(reason("exit 71"), "more memory than allowed, 1.0 GiB"));
  EXPECT_TRUE(contains(reason("[ $1 = --version ] || kill -11 $$"), "signal 11"));
  EXPECT_TRUE(contains(reason("exit 5"), "exit code 5"));
  EXPECT_EQ(reason("echo first >&2; echo 'lacuna: it is bad' >&2; exit 3"), "it is bad");
  const std::string flood = reason("yes flood | head -c 900000 >&2; exit 3");
  EXPECT_EQ(flood, "flood");
  const std::string endless = reason("while :; do printf xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx; done");
  EXPECT_TRUE(contains(endless, "its check failed")) << endless;
  EXPECT_LE(reason("head -c 9000 /dev/zero | tr '\\0' x; exit 3").size(), 4096U);
  EXPECT_TRUE(scenes().empty());
}

TEST_F(Uploads, ASceneThatCannotBeCheckedNowIsNotRefused) {
  for (const char* text :
       {"echo 'lacuna: no descriptor is left' >&2; exit 75", "exec /nowhere", "kill -11 $$"}) {
    SceneUploads uploads = make(script(text));
    const auto result = put(uploads, "a.glb", "glTF");
    EXPECT_EQ(result.outcome, Outcome::busy) << text;
    EXPECT_FALSE(result.reason.empty()) << text;
  }
  SceneUploads uploads = make(script("exit 0"));
  {
    const FailingFiles failing(FileCall::fsync, "scenes");
    EXPECT_THROW(put(uploads, "a.glb", "glTF"), std::system_error);
  }
  EXPECT_TRUE(scenes().empty());
}

TEST_F(Uploads, ACheckThatTakesTooLongIsKilledWithAllItStarted) {
  // On a busy machine the shell may need longer than the first limits to write the file.
  for (std::chrono::milliseconds limit(300); content_of(temp / "child").empty(); limit *= 4) {
    ASSERT_LT(limit, std::chrono::minutes(2)) << "the check does not begin";
    SceneUploads uploads({.folder = folder,
                          .renderer = script("sleep 600 & echo $! > ../child; sleep 600"),
                          .limits = {},
                          .time = limit});
    const auto result = put(uploads, "a.glb", "glTF");
    EXPECT_EQ(result.outcome, Outcome::refused);
    const double seconds = std::chrono::duration<double>(limit).count();
    EXPECT_TRUE(contains(result.reason, fmt::format("{} s", seconds))) << result.reason;
  }
  const pid_t child = std::stoi(content_of(temp / "child"));
  for (int i = 0; i < 1000 && ::kill(child, 0) == 0;
       ++i) {  // until its new parent takes its status
    if (contains(content_of("/proc/" + std::to_string(child) + "/stat"), ") Z ")) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  const std::string stat = content_of("/proc/" + std::to_string(child) + "/stat");
  EXPECT_TRUE(stat.empty() || contains(stat, ") Z ")) << stat;
  EXPECT_TRUE(scenes().empty());
}

TEST_F(Uploads, OneCheckAtATimeAndNoneOnceTheServiceEnds) {
  SceneUploads uploads = make(script("touch ../begun; sleep 600"));
  auto first = std::async(std::launch::async, [&] { return put(uploads, "a.glb", "glTF"); });
  for (int i = 0; i < 60'000 && !fs::exists(temp / "begun"); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ASSERT_TRUE(fs::exists(temp / "begun")) << "the check does not begin";
  EXPECT_EQ(put(uploads, "b.glb", "glTF").outcome, Outcome::busy);
  uploads.stop();
  EXPECT_EQ(first.get().outcome, Outcome::busy);
  EXPECT_EQ(put(uploads, "b.glb", "glTF").outcome, Outcome::busy);
  EXPECT_TRUE(scenes().empty());
}

TEST_F(Uploads, LeftoversOfAnEarlierServiceAreRemoved) {
  put_file(folder / ".upload-AbCdEf/0123.glb", "half");
  put_file(folder / "kept.glb", "whole");
  const SceneUploads uploads = make();
  EXPECT_EQ(scenes(), std::set<std::string>{"kept.glb"});
}

TEST(UploadName, IsPlain) {
  const std::string longest(80, 'a');
  for (const std::string& good : {std::string("a.glb"), std::string("Room_2-final.v1.glb"),
                                  std::string("0.glb"), longest + ".glb"}) {
    EXPECT_TRUE(is_upload_name(good)) << good;
  }
  for (const std::string& bad :
       {std::string(), std::string(".glb"), std::string("a"), std::string("a.gltf"),
        std::string("a.GLB"), std::string(".a.glb"), std::string("-a.glb"), std::string("_a.glb"),
        std::string("a..glb"), std::string("a..b.glb"), std::string("a/b.glb"),
        std::string("../a.glb"), std::string("a b.glb"), std::string("\xc3\xa4.glb"),
        std::string("a\0.glb", 6), std::string("a\n.glb"), longest + "a.glb"}) {
    EXPECT_FALSE(is_upload_name(bad)) << bad;
  }
}

TEST_F(Uploads, AnotherNameIsRefused) {
  SceneUploads uploads = make();
  EXPECT_THROW(put(uploads, "../a.glb", scene("cornell.glb")), std::invalid_argument);
  EXPECT_TRUE(names_in(temp.path()).contains("scenes"));
  EXPECT_FALSE(fs::exists(temp / "a.glb"));
}

}  // namespace
}  // namespace lacuna
