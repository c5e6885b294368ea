#include "jobs/spec/described_json.h"
#include "jobs/store/job_folder.h"
#include "tests/fuzz/expect.h"
#include "tests/fuzz/target.h"

// outcome.json and progress.json: refused with their problems, or written and read back without a
// change. The text is tried as both.

namespace lacuna::fuzz {
namespace {

constexpr DocumentLimits limits{1 << 16, 8};

template <Described T>
void expect_read_back(std::string_view text) {
  T document;
  try {
    document = read_document<T>(text, limits);
  } catch (const BadJob& bad) {
    expect(!bad.problems().empty(), "a document that is refused has a problem");
    return;
  }
  expect(read_document<T>(write_document(document), {1 << 20, 8}) == document,
         "a document that is written reads back equal");
}

}  // namespace
}  // namespace lacuna::fuzz

LACUNA_FUZZ_TARGET(documents) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  lacuna::fuzz::expect_read_back<lacuna::JobState>(text);
  lacuna::fuzz::expect_read_back<lacuna::Progress>(text);
  return 0;
}
