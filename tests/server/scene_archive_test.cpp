#include "server/routes/scene_archive.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <zip.h>

#include <utility>
#include <vector>

#include "server/routes/scene_uploads.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;

struct Member {
  std::string name, content;
  zip_uint32_t mode = S_IFREG | 0644;
};

fs::path zip_of(const fs::path& file, const std::vector<Member>& members) {
  zip_t* zip = zip_open(file.c_str(), ZIP_CREATE | ZIP_TRUNCATE, nullptr);
  for (const Member& m : members) {
    zip_source_t* source = zip_source_buffer(zip, m.content.data(), m.content.size(), 0);
    const zip_int64_t i = zip_file_add(zip, m.name.c_str(), source, 0);
    EXPECT_GE(i, 0) << m.name;
    zip_file_set_external_attributes(zip, static_cast<zip_uint64_t>(i), 0, ZIP_OPSYS_UNIX,
                                     m.mode << 16);
  }
  EXPECT_EQ(zip_close(zip), 0);
  return file;
}

std::string content_of_scene(const std::string& name) {
  return content_of(fs::path(LACUNA_SOURCE_DIR) / "jobs/scenes" / name);
}

class SceneArchive : public testing::Test {
 protected:
  std::string refusal(const std::vector<Member>& members, std::uint64_t max = max_unpacked_bytes) {
    const fs::path file = zip_of(temp / "a.zip", members);
    const fs::path out = temp / "out";
    fs::remove_all(out);
    try {
      unpack_scene(file, out, max);
    } catch (const BadArchive& error) {
      return error.what();
    }
    return "";
  }
  TemporaryFolder temp;
};

TEST_F(SceneArchive, AFolderIsUnpackedWithOrWithoutItsName) {
  for (const std::string top : {"", "room/"}) {
    EXPECT_EQ(refusal({{top + "scene.glb", "glTF"},
                       {top + "textures/wood.png", std::string(200'000, 'w')},
                       {"__MACOSX/._scene.glb", "x"},
                       {top + ".DS_Store", "x"}}),
              "");
    EXPECT_EQ(names_in(temp / "out"), (std::set<std::string>{"scene.glb", "textures"}));
    EXPECT_EQ(content_of(temp / "out/textures/wood.png"), std::string(200'000, 'w'));
  }
}

TEST_F(SceneArchive, NothingButPlainFilesInsideTheFolderComesOut) {
  const Member scene{"scene.glb", "glTF"};
  for (const std::string name :
       {"../a", "a/../../b", "/etc/a", "a//b", "./a", "a\\..\\b", "a\nb", "1/2/3/4/5/6/7/8/9/a"}) {
    EXPECT_TRUE(contains(refusal({scene, {name, "x"}}), name)) << name;
    EXPECT_FALSE(fs::exists(temp / "out")) << name;
  }
  EXPECT_TRUE(contains(refusal({scene, {"link", "/etc/passwd", S_IFLNK | 0777}}), "\"link\""));
  EXPECT_TRUE(contains(refusal({scene, {"a", "x"}, {"a/b", "x"}}), "one name"));
  EXPECT_TRUE(contains(refusal({{"room/scene.glb", "glTF"}, {"b/a.png", "x"}}), "\"b/a.png\""));
  EXPECT_TRUE(contains(refusal({{"a.glb", "glTF"}}), "scene.glb"));
  EXPECT_TRUE(contains(refusal({{"a/b/scene.glb", "glTF"}}), "scene.glb"));
}

TEST_F(SceneArchive, SizesAndCountsHaveLimits) {
  std::vector<Member> many(max_archived_files + 1, Member{"", ""});
  for (std::size_t i = 0; i < many.size(); ++i) many[i].name = std::to_string(i);
  EXPECT_TRUE(contains(refusal(many), "at most 10000"));
  EXPECT_TRUE(
      contains(refusal({{"scene.glb", "glTF"}, {"a", std::string(1021, '\0')}}, 1024), "1.0 KiB"));
  EXPECT_FALSE(fs::exists(temp / "out"));
  EXPECT_EQ(refusal({{"scene.glb", "glTF"}, {"a", std::string(1020, '\0')}}, 1024), "");
}

TEST_F(SceneArchive, DamagedArchivesAreRefused) {
  const fs::path file = zip_of(
      temp / "a.zip", {{"scene.glb", std::string(5000, 'g') + "TF"}, {"b.png", "0123456789"}});
  const std::string whole = content_of(file);
  for (std::size_t cut = 0; cut < whole.size(); cut += 7) {
    put_file(file, whole.substr(0, cut));
    fs::remove_all(temp / "out");
    EXPECT_THROW(unpack_scene(file, temp / "out"), BadArchive) << cut;
  }
  std::string other = whole;
  const std::size_t at = other.find("0123456789");
  ASSERT_NE(at, std::string::npos);  // too short to compress
  other[at] = 'x';
  put_file(file, other);
  fs::remove_all(temp / "out");
  EXPECT_THROW(unpack_scene(file, temp / "out"), BadArchive) << "a wrong checksum";
}

TEST_F(SceneArchive, AnUploadedFolderGetsItsNameOnceAndIsNeverReplaced) {
  const fs::path folder = temp / "scenes";
  SceneUploads uploads(
      {.folder = folder,
       .renderer = fs::read_symlink("/proc/self/exe").parent_path() / "../bin/lacuna",
       .limits = {}});
  const auto put = [&](const std::vector<Member>& members) {
    const std::string body = content_of(zip_of(temp / "a.zip", members));
    SceneUploads::Draft draft = uploads.begin();
    EXPECT_EQ(::write(draft.fd(), body.data(), body.size()), static_cast<ssize_t>(body.size()));
    return uploads.publish(std::move(draft), "room.zip");
  };
  const Member job{"job.json", "{}"};
  const Member good{"scene.glb", content_of_scene("cornell.glb")};
  const Member bad{"scene.glb", "glTF and no more"};
  EXPECT_EQ(put({bad, job}).outcome, SceneUploads::Outcome::refused);
  EXPECT_EQ(names_in(folder), std::set<std::string>{".uploads"});
  const SceneUploads::Result first = put({good, job});
  EXPECT_EQ(first.outcome, SceneUploads::Outcome::created) << first.reason;
  EXPECT_EQ(first.scene, "room/scene.glb");
  EXPECT_EQ(names_in(folder / "room"), (std::set<std::string>{"scene.glb", "job.json"}));
  EXPECT_EQ(put({good, job}).outcome, SceneUploads::Outcome::same);
  EXPECT_EQ(put({good}).outcome, SceneUploads::Outcome::conflict);
  EXPECT_EQ(put({good, {"job.json", "[]"}}).outcome, SceneUploads::Outcome::conflict);
  EXPECT_EQ(names_in(folder), (std::set<std::string>{".uploads", "room"}));
}

}  // namespace
}  // namespace lacuna
