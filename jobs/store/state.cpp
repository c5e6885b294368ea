#include "jobs/store/state.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace lacuna {
namespace {

constexpr std::string_view service = "service", person = "person";

// `interrupted` occurs only in the folder of a job, after a renderer that stopped before the end.
constexpr Transition transitions[] = {
    {State::queued, State::running, service, "its renderer starts"},
    {State::queued, State::held, person, "holds it"},
    {State::queued, State::cancelled, person, "cancels it before a renderer starts"},
    {State::queued, State::cancelling, person, "cancels it while a renderer starts or ends"},
    {State::queued, State::done, service, "an earlier renderer had finished"},
    {State::queued, State::failed, service, "its folder is damaged, or Slurm refuses its request"},
    {State::running, State::cancelling, person, "cancels it, which stops its renderer"},
    {State::running, State::queued, service,
     "its renderer stopped before the end or crashed: it continues from its checkpoint"},
    {State::running, State::held, service, "its renderer has stopped because the job is held"},
    {State::running, State::done, service, "the budget is spent, the results are written"},
    {State::running, State::failed, service,
     "the job or an asset is invalid, or renderers crashed too often"},
    {State::held, State::queued, person, "releases it"},
    {State::held, State::cancelled, person, "cancels it"},
    {State::cancelling, State::cancelled, service, "its renderer has ended"},
    {State::cancelling, State::done, service, "the request came too late"},
    {State::cancelling, State::failed, service, "the request came too late"},
    {State::failed, State::queued, person, "retries or extends it"},
    {State::cancelled, State::queued, person, "retries or extends it"},
    {State::done, State::queued, person, "extends its budget"},
};

}  // namespace

bool is_terminal(State s) {
  return s == State::done || s == State::failed || s == State::cancelled;
}

bool allows(State s, JobAction action) {
  const bool waits = s == State::queued || s == State::running;
  switch (action) {
    case JobAction::hold:
      return waits;
    case JobAction::release:
      return s == State::held;
    case JobAction::cancel:
    case JobAction::priority:
      return waits || s == State::held;
    case JobAction::retry:
      return s == State::failed || s == State::cancelled;
    case JobAction::extend:
    case JobAction::remove:
      break;
  }
  return is_terminal(s);
}

std::vector<std::string> allowed_actions(State s) {
  std::vector<std::string> names;
  for (const auto& [action, name, doc] : EnumTable<JobAction>::values) {
    if (allows(s, action)) names.emplace_back(name);
  }
  return names;
}

std::span<const Transition> state_transitions() { return transitions; }

std::string state_documentation() {
  std::string page = "| state | meaning | a person may |\n| --- | --- | --- |\n";
  for (const auto& [state, name, doc] : EnumTable<State>::values) {
    page += fmt::format("| `{}` | {}{} | {} |\n", name, doc, is_terminal(state) ? " (an end)" : "",
                        fmt::join(allowed_actions(state), ", "));
  }
  page += "\n| from | to | by | when |\n| --- | --- | --- | --- |\n";
  for (const Transition& t : transitions) {
    page +=
        fmt::format("| `{}` | `{}` | {} | {} |\n", enum_name(t.from), enum_name(t.to), t.by, t.why);
  }
  return page;
}

}  // namespace lacuna
