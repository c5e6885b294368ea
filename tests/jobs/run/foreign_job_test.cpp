#include "jobs/run/foreign_job.h"

#include "base/json/json_text.h"
#include "jobs/run/foreign_program.h"
#include "jobs/spec/job_json.h"
#include "renderer/core/scene_error.h"
#include "renderer/images/exr_write.h"
#include "tests/jobs/run/run_job_fixture.h"

namespace lacuna {
namespace {

using nlohmann::json;

class ForeignJob : public test::RunJob {
 protected:
  /// Writes an EXR of one colour, 24 x 16 pixels, of which every second pixel is `noise` brighter
  /// and every other one darker.
  void picture(const std::string& name, double value, double noise = 0) const {
    ExrPicture p{24, 16, {{"", {"R", "G", "B"}, {}}}, PixelType::single_float, {}};
    for (int i = 0; i < 24 * 16; ++i) {
      for (int c = 0; c < 3; ++c) {
        p.layers[0].values.push_back(value + (i % 2 == 0 ? noise : -noise));
      }
    }
    write_exr(temp.path() / name, p);
  }
  JobSpec foreign(const ForeignSettings& settings) const {
    JobSpec s = spec();
    s.reference = "truth.exr";
    s.integrator = settings;
    return s;
  }
  static ForeignSettings command(const std::string& script) {
    ForeignSettings f;
    f.program = "copy";
    f.command = {"sh", "-c", script};
    return f;
  }
  std::string curve(const JobFolder& folder) const {
    return read_file(folder.file("curve.csv"), 1 << 20);
  }
  static std::size_t lines(const std::string& text) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }
  std::string refusal(const JobFolder& folder) {
    try {
      run(folder);
    } catch (const std::exception& e) {
      return e.what();
    }
    return "";
  }
};

TEST(ForeignProgram, FillsInPlaceholdersOnly) {
  const Placeholders values{{"seed", "7"}, {"out", "a b"}};
  EXPECT_EQ(fill_in("{out}-{seed}{seed}", values), "a b-77");
  EXPECT_EQ(fill_in("{", values), "{");
  EXPECT_EQ(fill_in("awk '{print $1}' {{seed}} {other", values), "awk '{print $1}' {7} {other");
}

TEST_F(ForeignJob, PicturesBecomeACurve) {
  picture("truth.exr", 1);
  picture("a-3.exr", 1, .5);
  picture("b-3.exr", 1, .25);
  picture("other.exr", 1);
  ForeignSettings f;
  f.program = "Other";
  f.pictures = {{"b-{seed}.exr", 4, 3.5, {}}, {"a-{seed}.exr", 1, {}, {}}, {"other.exr", 9, {}, 4}};
  JobSpec s = foreign(f);
  s.seed = 3;
  const JobFolder folder = create(s);
  ASSERT_EQ(run(folder), Outcome::done);
  const std::string csv = curve(folder);
  ASSERT_EQ(lines(csv), 3u) << csv;
  // Iterations, samples and rays are not known, nor is the CPU time of the first.
  EXPECT_NE(csv.find("\n,1,,,,,0.5,0.5,0.25,"), std::string::npos) << csv;
  EXPECT_NE(csv.find("\n,4,3.5,,,,0.25,0.25,0.0625,"), std::string::npos) << csv;
  EXPECT_TRUE(observer.warnings.empty()) << observer.warnings.front();
  EXPECT_FLOAT_EQ(pixels(folder)[0], 1.25F);
  const json r = report(folder);
  EXPECT_EQ(r["errors"]["mse"], .0625);
  EXPECT_EQ(r["seconds"], json({{"render", 4.0}, {"render_cpu", 3.5}}));
}

TEST_F(ForeignJob, ASeedWithoutPicturesIsDoneWithoutACurve) {
  picture("truth.exr", 1);
  ForeignSettings f;
  f.program = "Other";
  f.pictures = {{"truth.exr", 4, {}, {}}};
  JobSpec s = foreign(f);
  s.seed = 2;
  const JobFolder folder = create(s);
  ASSERT_EQ(run(folder), Outcome::done);
  EXPECT_EQ(lines(curve(folder)), 1u);
  EXPECT_EQ(observer.warnings, (std::vector<std::string>{"\"pictures\" has none of seed 2"}));
}

TEST_F(ForeignJob, WarnsOfAMeanThatNoiseDoesNotExplain) {
  ForeignSettings f;
  f.program = "Other";
  f.pictures = {{"a.exr", 1, {}, {}}};
  picture("truth.exr", 1, .5);
  picture("a.exr", 1.05, .5);
  ASSERT_EQ(run(create(foreign(f))), Outcome::done);
  // One block of 16 x 16 pixels is a single deviation: no statement.
  EXPECT_TRUE(observer.warnings.empty());
  JobSpec wide = foreign(f);
  wide.resolution = {96, 64};
  ExrPicture p{96,
               64,
               {{"", {"R", "G", "B"}, std::vector<double>(96 * 64 * 3, 1)}},
               PixelType::single_float,
               {}};
  write_exr(temp.path() / "truth.exr", p);
  for (double& v : p.layers[0].values) v = 1.05;
  write_exr(temp.path() / "a.exr", p);
  ASSERT_EQ(run(create(wide, "wide")), Outcome::done);
  ASSERT_EQ(observer.warnings.size(), 1u);
  EXPECT_NE(observer.warnings[0].find("+5.00 % off"), std::string::npos) << observer.warnings[0];
}

TEST_F(ForeignJob, RefusesPicturesOfAnotherSizeAndMissingOnes) {
  picture("truth.exr", 1);
  write_exr(temp.path() / "small.exr",
            {1, 1, {{"", {"R", "G", "B"}, {1, 1, 1}}}, PixelType::single_float, {}});
  ForeignSettings f;
  f.program = "Other";
  f.pictures = {{"small.exr", 1, {}, {}}};
  EXPECT_NE(refusal(create(foreign(f))).find("has 1 x 1 pixels, but the job has 24 x 16"),
            std::string::npos);
  f.pictures = {{"none.exr", 1, {}, {}}};
  EXPECT_NE(refusal(create(foreign(f), "none")).find("none.exr"), std::string::npos);
}

TEST_F(ForeignJob, ACommandIsRunForEachTimeAndMeasured) {
  picture("truth.exr", 1);
  const std::string truth = (temp.path() / "truth.exr").string();
  ForeignSettings f = command("echo {seconds} {seed} {width} {threads}; cp " + truth +
                              " {out}; i=0; while [ $i -lt 100000 ]; do i=$((i+1)); done");
  f.seconds = {1, 2};
  const JobFolder folder = create(foreign(f));
  ASSERT_EQ(run(folder), Outcome::done);
  EXPECT_EQ(read_file(folder.file("program.log"), 1 << 20), "1 1 24 2\n2 1 24 2\n");
  EXPECT_EQ(lines(curve(folder)), 3u);
  const json seconds = report(folder)["seconds"];
  EXPECT_GT(seconds["render"], 0);
  EXPECT_GT(seconds["render_cpu"], 0);
  // On two threads at most twice the wall clock, and here one of them.
  EXPECT_LT(seconds["render_cpu"], seconds["render"]);
}

TEST_F(ForeignJob, PicturesOfAnInterruptedCommandStay) {
  picture("truth.exr", 1);
  const std::string truth = (temp.path() / "truth.exr").string();
  ForeignSettings f = command("cp " + truth + " {out}; [ {seconds} = 1 ] || sleep 20");
  f.seconds = {1, 2};
  const JobFolder folder = create(foreign(f));
  const auto second = [&] { return std::filesystem::exists(folder.file("picture-2.exr")); };
  EXPECT_EQ(run_job(folder, context(second)), Outcome::interrupted);
  EXPECT_EQ(folder.read_state().state, State::interrupted);
  const json record = parse_own_sorted(read_file(folder.file("measured.json"), 1 << 20));
  EXPECT_EQ(record["pictures"].size(), 1u);
  // They belong to the files from which they were made.
  picture("truth.exr", 2);
  EXPECT_NE(refusal(folder).find("have changed since it was rendered"), std::string::npos);
}

TEST_F(ForeignJob, ACommandThatFailsSaysWhy) {
  picture("truth.exr", 1);
  EXPECT_NE(refusal(create(foreign(command("echo no licence; exit 3"))))
                .find("\"sh\" ended with exit code 3; its output: no licence"),
            std::string::npos);
  EXPECT_NE(refusal(create(foreign(command("true")), "b")).find("ended without writing"),
            std::string::npos);
  ForeignSettings slow = command("sleep 20");
  slow.timeout = .05;
  EXPECT_NE(refusal(create(foreign(slow), "c")).find("was killed after 0.05 s"), std::string::npos);
  ForeignSettings missing = command("");
  missing.command = {"no-such-program"};
  EXPECT_NE(refusal(create(foreign(missing), "d")).find("no program \"no-such-program\""),
            std::string::npos);
  ForeignSettings late = command("cp " + (temp.path() / "truth.exr").string() + " {out}");
  late.start.seconds = 100;
  EXPECT_NE(refusal(create(foreign(late), "e")).find("\"start\" of 100"), std::string::npos);
}

TEST(ForeignSettings, HavePicturesOrACommand) {
  const auto refusal = [](const std::string& more) -> std::string {
    try {
      parse_job(R"({"scene": "a.glb", "integrator": {"type": "foreign", "name": "x")" + more +
                "}}");
    } catch (const BadJob& bad) {
      return bad.problems().front().pointer + " " + bad.problems().front().message;
    }
    return "";
  };
  EXPECT_EQ(refusal(R"(, "command": ["a"])"), "");
  EXPECT_EQ(refusal(R"(, "pictures": [{"file": "a.exr", "seconds": 1}])"), "");
  const std::string one =
      "/integrator found \"pictures\" and \"command\" both or neither; allowed: "
      "one of the two";
  EXPECT_EQ(refusal(""), one);
  EXPECT_EQ(refusal(R"(, "command": ["a"], "pictures": [{"file": "a.exr", "seconds": 1}])"), one);
  EXPECT_NE(refusal(R"(, "command": [""])"), "");
  EXPECT_EQ(refusal(R"(, "command": ["a"]}, "layers": ["variance"], "budget": {)").substr(0, 7),
            "/layers");
  EXPECT_EQ(refusal(R"(, "command": ["a"]}, "shards": 2, "budget": {)").substr(0, 7), "/shards");
  EXPECT_NE(refusal(R"(, "pictures": [{"file": "a.exr", "seconds": 0}])"), "");
}

}  // namespace
}  // namespace lacuna
