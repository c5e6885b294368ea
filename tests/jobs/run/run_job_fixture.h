#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <nlohmann/json.hpp>

#include "base/json/json_text.h"
#include "base/storage/atomic_file.h"
#include "jobs/run/run_job.h"
#include "renderer/images/image_read.h"
#include "tests/jobs/run/silent_observer.h"
#include "tests/temporary_folder.h"

namespace lacuna::test {

using nlohmann::json;

/// A data root of one test, with the project's scenes and one folder more.
class RunJob : public testing::Test {
 protected:
  RunContext context(const std::function<bool()>& interrupted) {
    return {DataRoot{temp.path()},
            ScenesRoots({std::filesystem::path(LACUNA_SOURCE_DIR) / "jobs/scenes", temp.path()}), 2,
            interrupted, observer};
  }
  JobFolder create(const JobSpec& spec, const std::string& name = "job") {
    return JobFolder::create(temp.path() / name, spec);
  }
  Outcome run(const JobFolder& folder) { return run_job(folder, context(never)); }
  Outcome run_until_asked(const JobFolder& folder, int patience) {
    std::atomic<int> asked{0};
    return run_job(folder, context([&] { return ++asked > patience; }));
  }
  /// Runs it, again and with more patience each time, until an iteration is in its checkpoint.
  /// Returns the patience that this took.
  int interrupt_with_checkpoint(const JobFolder& folder) {
    int patience = 0;
    while (folder.read_progress().value_or(Progress{}).iteration == 0) {
      EXPECT_EQ(run_until_asked(folder, ++patience), Outcome::interrupted);
    }
    return patience;
  }
  static JobSpec spec(const std::string& scene = "cornell.glb", int iterations = 4) {
    JobSpec s;
    s.scene = scene;
    s.resolution = {24, 16};
    s.budget.iterations = iterations;
    return s;
  }
  static json report(const JobFolder& folder) {
    return parse_own_sorted(read_file(folder.file("report.json"), 1 << 20));
  }
  static std::vector<float> pixels(const JobFolder& folder, const std::string& layer = "") {
    return read_float_image(folder.file("image.exr"), layer).rgb;
  }

  TemporaryFolder temp;
  SilentObserver observer;
  const std::function<bool()> never = [] { return false; };
};

}  // namespace lacuna::test
