#include "jobs/store/state.h"

#include <algorithm>

namespace lacuna {
namespace {

struct Transition {
  State from, to;
};

/// Every change of state there is; from a terminal state there is none.
constexpr Transition transitions[] = {
    {State::queued, State::running},
    {State::queued, State::cancelled},        // nothing had started
    {State::queued, State::failed},           // no renderer could be started
    {State::queued, State::held},             // on request
    {State::running, State::held},            // on request, after the renderer has stopped
    {State::interrupted, State::held},        // likewise
    {State::held, State::queued},             // released
    {State::held, State::cancelled},          //
    {State::held, State::failed},             //
    {State::running, State::running},         // a new phase; a new renderer after one was killed
    {State::running, State::cancelling},      // on request, while the renderer lives
    {State::running, State::interrupted},     // the renderer stopped or died before the end
    {State::running, State::queued},          // its renderer crashed; another will go on
    {State::running, State::done},            //
    {State::running, State::failed},          //
    {State::running, State::cancelled},       // on request, after the renderer has died
    {State::cancelling, State::cancelled},    //
    {State::cancelling, State::interrupted},  // a renderer knows that it was stopped, not why
    {State::cancelling, State::done},         // the request came too late
    {State::cancelling, State::failed},       // likewise
    {State::interrupted, State::queued},      // waits for its turn again
    {State::interrupted, State::running},     //
    {State::interrupted, State::cancelled},   //
    {State::interrupted, State::failed},      // interrupted too often
};

}  // namespace

bool is_terminal(State s) {
  return std::none_of(std::begin(transitions), std::end(transitions),
                      [&](const Transition& t) { return t.from == s; });
}

bool may_follow(State from, State to) {
  return std::any_of(std::begin(transitions), std::end(transitions),
                     [&](const Transition& t) { return t.from == from && t.to == to; });
}

}  // namespace lacuna
