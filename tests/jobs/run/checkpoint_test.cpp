#include "jobs/run/checkpoint.h"

#include <gtest/gtest.h>

#include "analysis/storage/atomic_file.h"
#include "tests/renderer/gltf/glb_builder.h"

namespace lacuna {
namespace {

using namespace std::string_literals;

const std::string content = "what a picture needs to go on: \0 bytes of any kind"s;

TEST(Checkpoint, ComesBack) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "checkpoint.bin";
  EXPECT_FALSE(read_checkpoint(file, "key"));
  write_checkpoint(file, "key", content);
  EXPECT_EQ(read_checkpoint(file, "key"), content);
}

TEST(Checkpoint, OfAnotherPictureIsRefused) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "checkpoint.bin";
  write_checkpoint(file, "key", content);
  EXPECT_THROW(read_checkpoint(file, "other"), std::runtime_error);
}

TEST(Checkpoint, EveryDamagedByteAndEveryCutIsSeen) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "checkpoint.bin";
  write_checkpoint(file, "key", content);
  const std::string whole = read_file(file, 1 << 20);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x40);
    write_file_atomically(file, damaged, false);
    EXPECT_THROW(read_checkpoint(file, "key"), std::runtime_error) << "byte " << i;
    write_file_atomically(file, whole.substr(0, i), false);
    EXPECT_THROW(read_checkpoint(file, "key"), std::runtime_error) << "cut at " << i;
  }
  write_file_atomically(file, whole + "x", false);
  EXPECT_THROW(read_checkpoint(file, "key"), std::runtime_error);
}

}  // namespace
}  // namespace lacuna
