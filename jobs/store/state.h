#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/settings/field.h"

namespace lacuna {

/// The state of a job. state_transitions() lists the allowed changes.
enum class State { queued, running, held, cancelling, interrupted, done, failed, cancelled };

template <>
struct EnumTable<State> {
  static constexpr std::array<EnumValue<State>, 8> values{{
      {State::queued, "queued", "waits for its turn"},
      {State::running, "running", "a renderer works on it"},
      {State::held, "held", "does not start or continue until it is released"},
      {State::cancelling, "cancelling", "its renderer was asked to stop"},
      {State::interrupted, "interrupted",
       "of a folder: its renderer stopped before the end; it continues from its checkpoint"},
      {State::done, "done", "its budget is spent and its results are complete"},
      {State::failed, "failed", "it cannot be done; `error` says why"},
      {State::cancelled, "cancelled", "it was stopped on request"},
  }};
};

/// A job's priority is at most this, and at least its negative.
inline constexpr int max_priority = 100;

/// done, failed, cancelled: the state changes only at a user's request.
bool is_terminal(State s);

/// A request of a person about a job.
enum class JobAction { cancel, hold, release, priority, retry, extend, remove };

template <>
struct EnumTable<JobAction> {
  static constexpr std::array<EnumValue<JobAction>, 7> values{{
      {JobAction::cancel, "cancel", "ends it; what it has rendered is kept"},
      {JobAction::hold, "hold", "stops it until it is released"},
      {JobAction::release, "release", "lets it start or continue"},
      {JobAction::priority, "priority", "changes its place in the queue"},
      {JobAction::retry, "retry", "continues it after it failed or was cancelled"},
      {JobAction::extend, "extend", "gives it a larger budget"},
      {JobAction::remove, "delete", "deletes it with all its files"},
  }};
};

/// Whether `action` applies to a job in state `s`. The service may still refuse it, for example to
/// delete a job that another one needs.
bool allows(State s, JobAction action);
/// The names of all actions that `s` allows.
std::vector<std::string> allowed_actions(State s);

/// An allowed change of state.
struct Transition {
  State from, to;
  std::string_view by;   ///< who makes it: "service", "person"
  std::string_view why;  ///< when
};
/// The state machine: all allowed changes of state.
std::span<const Transition> state_transitions();
/// The state machine as a page of Markdown.
std::string state_documentation();

/// outcome.json, and the same fields in a queue. Times are UTC, ISO 8601 with milliseconds; empty:
/// not yet.
struct JobState {
  State state = State::queued;
  int attempts = 0;    ///< renderers started so far
  int exit_code = -1;  ///< of the last renderer; -1: none ended
  std::string created, started, finished;
  std::string phase;  ///< of a running job: "loading", "reference", "rendering", "writing"
  std::string error;  ///< one line; of `failed`, and of `interrupted` without a request
  std::vector<std::string> warnings;  ///< e.g. "the scene has no light: the picture is black"
  bool operator==(const JobState&) const = default;
};
template <class V>
void describe(V& v, JobState& s) {
  v("state", s.state, {.doc = "state of the job", .required = true});
  v("attempts", s.attempts, {.doc = "renderers started so far", .min = 0, .required = true});
  v("exit_code", s.exit_code, {.doc = "of the last renderer; -1: none ended"});
  v("created", s.created, {.doc = "UTC, ISO 8601"});
  v("started", s.started, {.doc = "UTC, ISO 8601; empty: not yet"});
  v("finished", s.finished, {.doc = "UTC, ISO 8601; empty: not yet"});
  v("phase", s.phase, {.doc = "of a running job"});
  v("error", s.error, {.doc = "why it failed or stopped early"});
  v("warnings", s.warnings, {.doc = "warnings about the result"});
}

}  // namespace lacuna
