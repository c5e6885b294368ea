#include "jobs/queue/exit_classification.h"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>

#include "jobs/store/exit_code.h"

namespace lacuna {
namespace {

ExitClassification failed(JobState state, const std::string& error, const std::string& now) {
  state.error = error;
  return {ended(std::move(state), State::failed, now)};
}

/// Whether `code` of this ending is an exit code.
bool exited(const Ending& end) {
  const bool by_others = end.kind == Ending::Kind::lost || end.kind == Ending::Kind::refused;
  return end.kind == Ending::Kind::exited || end.kind == Ending::Kind::out_of_memory ||
         (by_others && end.code != 0);
}

/// Whether another renderer would end in the same way.
bool is_final(const Ending& end) {
  if (end.kind == Ending::Kind::refused) return true;
  return end.kind == Ending::Kind::exited && (end.code == exit_bad_job || end.code == exit_asset);
}

bool interrupted(const Ending& end) {
  return end.kind == Ending::Kind::exited && end.code == exit_interrupted;
}

/// The transient reason why it could not be started or write its files; empty: none. A renderer
/// that was interrupted without a request writes the reason to outcome.json, if it can; one stopped
/// by another program leaves no error there.
std::string obstacle_of(const Attempt& attempt) {
  const Ending& end = attempt.ending;
  if (never_began(end)) return end.reason;
  // SIGBUS: a page of a mapped file, such as the program or a library, is truncated or unreadable.
  const bool by_file = end.code == SIGXFSZ || end.code == SIGBUS;
  if (end.kind == Ending::Kind::killed && by_file) return end.reason;
  if (!interrupted(end)) return "";
  if (attempt.after.state != State::interrupted) return "the renderer could not write its files";
  return attempt.after.error;
}

/// Whether a stopped renderer has completed an iteration.
bool made_progress(const Attempt& attempt) {
  const bool stopped = interrupted(attempt.ending) || attempt.ending.kind == Ending::Kind::lost;
  return stopped && attempt.iteration_after > attempt.iteration_before;
}

std::string reason_of(const Attempt& attempt) {
  const Ending& end = attempt.ending;
  if (interrupted(end)) return end.reason + ", without a request or progress";
  const bool silent = end.kind == Ending::Kind::exited && end.code == exit_done;
  return silent ? end.reason + " but left no result" : end.reason;
}

}  // namespace

JobState ended(JobState state, State how, const std::string& now) {
  state.state = how;
  state.phase.clear();
  if (how != State::failed) state.error.clear();
  state.finished = now;
  return state;
}

JobState queued(JobState state) {
  state.state = State::queued;
  state.phase.clear();
  state.error.clear();
  state.finished.clear();
  return state;
}

JobState held(JobState state) {
  state = queued(std::move(state));
  state.state = State::held;
  return state;
}

ExitClassification classify_exit(const Attempt& attempt, int max_attempts, const std::string& now) {
  JobState state = attempt.after;
  const Ending& end = attempt.ending;
  if (exited(end)) state.exit_code = end.code;
  if (end.kind == Ending::Kind::killed) state.exit_code = 128 + end.code;  // as in shells
  const bool started = !never_began(end) && end.kind != Ending::Kind::refused;
  // A renderer that died early did not count itself.
  state.attempts =
      std::max(state.attempts, attempt.before.attempts + (started && !attempt.found ? 1 : 0));
  if (is_terminal(state.state)) return {state};

  if (attempt.cancel) return {ended(std::move(state), State::cancelled, now)};
  if (attempt.hold) return {held(std::move(state))};
  if (attempt.stopped) return {queued(std::move(state))};
  if (is_final(end)) return failed(std::move(state), end.reason, now);
  const std::string obstacle = obstacle_of(attempt);
  if (!obstacle.empty()) return {queued(std::move(state)), false, obstacle};
  if (attempt.disk_low || made_progress(attempt)) return {queued(std::move(state))};
  const int crashes = attempt.crashes + 1;
  if (crashes < max_attempts) return {queued(std::move(state)), true};
  const std::string reason = reason_of(attempt);
  return failed(std::move(state),
                crashes == 1 ? reason : fmt::format("{}, {} times", reason, crashes), now);
}

}  // namespace lacuna
