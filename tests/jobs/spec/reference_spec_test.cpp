#include "jobs/spec/reference_spec.h"

#include <gtest/gtest.h>

#include "jobs/spec/job_json.h"

namespace lacuna {
namespace {

JobSpec job(const std::string& more) {
  return parse_job(R"({"scene": "a.glb", "reference": "auto")" + more + "}");
}

TEST(ReferenceSpec, EstimatesTheSamePicture) {
  const JobSpec r = reference_spec(
      job(R"(, "resolution": [8, 4], "pixel_filter": "tent", "seed": 3, "camera": "c",
    "integrator": {"type": "path", "max_depth": 5, "next_event_estimation": false})"));
  EXPECT_EQ(r.pixel_filter, PixelFilter::tent);  // another filter is another picture
  EXPECT_EQ(r.resolution, (std::array<int, 2>{8, 4}));
  EXPECT_EQ(r.camera.name, "c");
  EXPECT_NE(r.seed, 3u);
  BdptSettings plain;
  plain.max_depth = 5;
  EXPECT_EQ(std::get<BdptSettings>(r.integrator), plain);
  EXPECT_TRUE(r.reference.empty());
}

TEST(ReferenceSpec, FalseColoursDependOnTheAnalysis) {
  const std::string shape = R"(, "analysis": {"resolution": 32})";
  const std::string inspect = R"(, "integrator": {"type": "inspect", "show": "node_mapping"})";
  EXPECT_EQ(reference_spec(job(shape + inspect)).analysis.resolution, 32);
  EXPECT_EQ(reference_spec(job(shape)), reference_spec(job("")));
  const std::string normals = R"(, "integrator": {"type": "inspect", "show": "normal"})";
  EXPECT_EQ(reference_spec(job(shape + normals)), reference_spec(job(normals)));
}

TEST(PictureName, IsOneForMethodsOfOnePicture) {
  const auto name = [](const std::string& more) { return picture_name(job(more)); };
  EXPECT_EQ(name(""), name(R"(, "integrator": {"type": "path", "next_event_estimation": false})"));
  EXPECT_EQ(name(""), name(R"(, "seed": 7, "budget": {"seconds": 3}, "threads": 2)"));
  EXPECT_NE(name(""), name(R"(, "integrator": {"type": "path", "max_depth": 3})"));
  EXPECT_EQ(name(""), name(R"(, "integrator": {"type": "light"})"));
  EXPECT_EQ(name(""),
            name(R"(, "integrator": {"type": "bdpt", "connections": {"type": "skeleton"}})"));
  EXPECT_NE(name(""), name(R"(, "resolution": [8, 8])"));
  EXPECT_NE(name(""), name(R"(, "pixel_filter": "tent")"));
}

TEST(PictureName, OfANamedReferenceIsThatReference) {
  const auto a = parse_job(R"({"scene": "a.glb", "reference": "r.exr",
    "integrator": {"type": "path", "max_depth": 3}})");
  const auto b = parse_job(R"({"scene": "a.glb", "reference": "r.exr"})");
  EXPECT_EQ(picture_name(a), picture_name(b));  // depth trades bias for speed
}

}  // namespace
}  // namespace lacuna
