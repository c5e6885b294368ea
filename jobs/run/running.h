#pragma once

#include <string>
#include <utility>
#include <vector>

#include "jobs/run/observer.h"
#include "jobs/run/obstacle.h"
#include "jobs/store/job_folder.h"

namespace lacuna {

/// The job's state on disk and its phases' times while it runs.
class Running {
 public:
  Running(const JobFolder& folder, Observer& observer) : folder_(folder), observer_(observer) {
    state_ = folder.read_state();
    state_.state = State::running;
    state_.attempts += 1;
    state_.started = utc_now();
    if (state_.created.empty()) state_.created = state_.started;
    state_.finished.clear();
    state_.phase.clear();
    state_.error.clear();
    state_.warnings.clear();
  }

  void phase(const std::string& name) {
    // Synced once, so that no earlier end is found after a power failure.
    const bool begins = std::exchange(state_.phase, name).empty();
    folder_.write_state(state_, begins);
    observer_.phase(name);
  }
  const std::string& phase_name() const { return state_.phase; }
  void warn(const std::string& line) {
    state_.warnings.push_back(line);
    observer_.warning(line);
  }
  void finish(State state, const std::string& error = "") {
    state_.state = state;
    state_.phase.clear();
    state_.error = error;
    state_.finished = utc_now();
    folder_.write_state(state_);
  }
  /// After an exception, which takes precedence: a failure to write the state is only a warning.
  void stop(const std::exception& e) {
    const bool may_go_on = obstacle_of(e) != Obstacle::none;
    try {
      finish(may_go_on ? State::interrupted : State::failed, reason_of(e));
    } catch (const std::exception& second) {
      observer_.warning(second.what());
    }
  }
  const std::vector<std::string>& warnings() const { return state_.warnings; }

 private:
  JobFolder folder_;
  Observer& observer_;
  JobState state_;
};

}  // namespace lacuna
