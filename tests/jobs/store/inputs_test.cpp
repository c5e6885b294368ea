#include "jobs/store/inputs.h"

#include <gtest/gtest.h>

#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

const InputList recorded{{InputRole::scene, "a.gltf", 10, "0123456789abcdef"},
                         {InputRole::texture, "tex/\u00e4 \"b\".png", 20, "00000000000000ff"},
                         {InputRole::environment, "sky.hdr", 30, "00000000000000fe"}};

TEST(Inputs, ARecordIsReadAsItWasWritten) {
  const TemporaryFolder temp;
  const JobFolder folder(temp.path());
  EXPECT_FALSE(read_inputs(folder));
  write_inputs(folder, recorded);
  EXPECT_EQ(read_inputs(folder), recorded);
  temp.write("inputs.json", "{}");
  EXPECT_THROW(read_inputs(folder), std::runtime_error);
}

TEST(Inputs, ChangesAreToldByRoleAndName) {
  EXPECT_TRUE(changed_inputs(recorded, recorded).empty());
  InputList now = recorded;
  now[0].bytes = 11;
  now[0].hash = "fedcba9876543210";
  now[1].hash = "00000000000000fd";
  now[2] = {InputRole::environment, "sky.hdr", 0, ""};
  EXPECT_EQ(changed_inputs(recorded, now),
            (std::vector<std::string>{
                "scene \"a.gltf\" has 11 bytes, and had 10",
                "texture \"tex/\u00e4 \"b\".png\" has changed contents of the same size",
                "environment \"sky.hdr\" no longer exists"}));
  now = {{InputRole::reference, "sky.hdr", 1, "1"}};
  EXPECT_TRUE(changed_inputs(recorded, now).empty()) << "only what both lists have is compared";
}

}  // namespace
}  // namespace lacuna
