#include "jobs/spec/problems.h"

#include <utility>

namespace lacuna {
namespace {

std::string summary(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& p : problems) {
    if (!text.empty()) text += '\n';
    if (!p.pointer.empty()) text += p.pointer + ": ";
    text += p.message;
  }
  return text;
}

}  // namespace

BadJob::BadJob(std::vector<Problem> problems)
    : std::runtime_error(summary(problems)), problems_(std::move(problems)) {}

}  // namespace lacuna
