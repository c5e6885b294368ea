#include "server/verdict.h"

#include <fmt/format.h>

#include <algorithm>

#include "jobs/cli/commands.h"

namespace lacuna {
namespace {

Verdict failed(JobState state, const std::string& error, const std::string& now) {
  state.error = error;
  return {ended(std::move(state), State::failed, now)};
}

}  // namespace

JobState ended(JobState state, State how, const std::string& now) {
  state.state = how;
  state.phase.clear();
  state.finished = now;
  return state;
}

JobState queued(JobState state) {
  state.state = State::queued;
  state.phase.clear();
  state.finished.clear();
  return state;
}

Verdict judge(const Attempt& attempt, int max_attempts, const std::string& now) {
  JobState state = attempt.after;
  const Ending& end = attempt.ending;
  if (end.kind == Ending::Kind::exited) state.exit_code = end.code;
  if (end.kind == Ending::Kind::killed) state.exit_code = 128 + end.code;  // as shells have it
  if (is_terminal(state.state)) return {state};
  const bool started = end.kind != Ending::Kind::not_started;
  // A renderer that died early did not count itself.
  state.attempts = std::max(state.attempts, attempt.before.attempts + (started ? 1 : 0));

  if (attempt.cancel) return {ended(std::move(state), State::cancelled, now)};
  if (attempt.stopped) return {queued(std::move(state))};
  if (!started) return failed(std::move(state), end.reason, now);
  if (end.kind == Ending::Kind::exited) {
    if (end.code == exit_interrupted) return {queued(std::move(state))};
    if (end.code == exit_bad_job || end.code == exit_asset) {
      return failed(std::move(state), end.reason, now);
    }
  }
  const int crashes = attempt.crashes + 1;
  if (crashes < max_attempts) return {queued(std::move(state)), true};
  const std::string reason = end.kind == Ending::Kind::exited && end.code == exit_done
                                 ? end.reason + " but left no result"
                                 : end.reason;
  return failed(std::move(state),
                crashes == 1 ? reason : fmt::format("{}, {} times", reason, crashes), now);
}

}  // namespace lacuna
