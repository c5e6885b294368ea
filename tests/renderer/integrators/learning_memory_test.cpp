// What guides keep to learn from is refused before it takes more memory than there is.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <fstream>

#include "analysis/space/memory_limit.h"
#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/render.h"

namespace lacuna {
namespace {

/// While it lives, this process can allocate `more` bytes of data.
class DataLimit {
 public:
  explicit DataLimit(std::uint64_t more) {
    ::getrlimit(RLIMIT_DATA, &before_);
    std::uint64_t pages = 0;
    std::ifstream statm("/proc/self/statm");
    for (int i = 0; i < 6; ++i) statm >> pages;  // the sixth is data and stack
    rlimit limit = before_;
    limit.rlim_cur = pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) + more;
    ::setrlimit(RLIMIT_DATA, &limit);
  }
  ~DataLimit() { ::setrlimit(RLIMIT_DATA, &before_); }
  DataLimit(const DataLimit&) = delete;
  DataLimit& operator=(const DataLimit&) = delete;

 private:
  rlimit before_{};
};

/// Renders an iteration of 1,024 tiles, whose paths would keep some 200 MiB to learn from, where 48
/// are free.
void expect_refused(const IntegratorSettings& method) {
  test::Session session(load_gltf(test::own_scene("cornell.glb")),
                        {.integrator = method, .width = 1024, .height = 1024, .threads = 2});
  const DataLimit limit(std::uint64_t{48} << 20);
  try {
    session.iterate(0);
    ADD_FAILURE() << "was not refused";
  } catch (const MemoryLimitError& e) {
    EXPECT_NE(std::string(e.what()).find("a guide keeps"), std::string::npos) << e.what();
  }
}

TEST(LearningMemory, IsRefusedBeforeItIsSpent) {
  SdTreeGuideSettings tree;
  tree.probability = {0.5};
  PathSettings path = test::path_tracing(3);
  path.guide = tree;
  expect_refused(path);
  BdptSettings bdpt = test::joining(3, UniformSettings{});
  bdpt.guide = tree;
  expect_refused(bdpt);
}

}  // namespace
}  // namespace lacuna
