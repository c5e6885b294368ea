#include "jobs/store/state.h"

#include <fmt/format.h>

#include <algorithm>

namespace lacuna {
namespace {

constexpr std::string_view service = "service", renderer = "renderer", person = "person";

constexpr Transition transitions[] = {
    {State::queued, State::running, renderer, "it starts"},
    {State::queued, State::held, person, "holds it"},
    {State::queued, State::cancelled, person, "cancels it; nothing had started"},
    {State::queued, State::cancelling, person, "cancels it while an earlier renderer still ends"},
    {State::queued, State::done, renderer, "an earlier one ends after a restart of the service"},
    {State::queued, State::failed, service,
     "its folder is damaged, or Slurm refuses what it asks for"},
    {State::running, State::running, renderer, "a new phase, or a new attempt after a crash"},
    {State::running, State::cancelling, person, "cancels it; its renderer is asked to stop"},
    {State::running, State::interrupted, renderer, "it stops before the end, with a checkpoint"},
    {State::running, State::queued, service,
     "its renderer crashed, or there is no room on the disk"},
    {State::running, State::held, service, "its renderer has stopped because the job is held"},
    {State::running, State::done, renderer, "the budget is spent, the results are written"},
    {State::running, State::failed, renderer,
     "the job or an asset is bad; the service: it crashed too often"},
    {State::running, State::cancelled, service, "its renderer has ended after it was cancelled"},
    {State::held, State::queued, person, "releases it"},
    {State::held, State::cancelled, person, "cancels it"},
    {State::cancelling, State::cancelled, service, "its renderer has ended"},
    {State::cancelling, State::interrupted, renderer, "it knows that it was stopped, not why"},
    {State::cancelling, State::done, renderer, "the request came too late"},
    {State::cancelling, State::failed, renderer, "the request came too late"},
    {State::interrupted, State::queued, service, "it waits for its turn again"},
    {State::interrupted, State::running, renderer, "it goes on"},
    {State::interrupted, State::held, service, "its renderer has stopped because the job is held"},
    {State::interrupted, State::cancelling, person, "cancels it just then"},
    {State::interrupted, State::cancelled, service,
     "its renderer has ended after it was cancelled"},
    {State::interrupted, State::failed, service, "it was interrupted too often without progress"},
    {State::failed, State::queued, person, "retries or extends it"},
    {State::cancelled, State::queued, person, "retries or extends it"},
    {State::done, State::queued, person, "extends its budget"},
};

}  // namespace

bool is_terminal(State s) {
  return s == State::done || s == State::failed || s == State::cancelled;
}

std::span<const Transition> state_transitions() { return transitions; }

bool may_follow(State from, State to) {
  return std::any_of(std::begin(transitions), std::end(transitions),
                     [&](const Transition& t) { return t.from == from && t.to == to; });
}

std::string state_documentation() {
  std::string page = "| state | meaning |\n| --- | --- |\n";
  for (const auto& [state, name, doc] : EnumTable<State>::values) {
    page += fmt::format("| `{}` | {}{} |\n", name, doc, is_terminal(state) ? " (an end)" : "");
  }
  page += "\n| from | to | by | when |\n| --- | --- | --- | --- |\n";
  for (const Transition& t : transitions) {
    page +=
        fmt::format("| `{}` | `{}` | {} | {} |\n", enum_name(t.from), enum_name(t.to), t.by, t.why);
  }
  return page;
}

}  // namespace lacuna
