#pragma once

#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "jobs/run/choice.h"
#include "jobs/run/prepare.h"
#include "jobs/run/render_loop.h"

namespace lacuna {

/// The share of the budget that all candidates together may spend until one is left, and the share
/// that each may have spent by the end of `round`, from 0: it doubles each round, in which half of
/// the candidates are eliminated (successive halving: Jamieson and Talwalkar 2016).
inline constexpr double choosing_share = 0.1;
/// The share of the budget in which a candidate must finish its first iteration. Until a first
/// candidate has finished one, there is no limit: a job has at least one iteration.
inline constexpr double first_iteration_share = 1.0 / 24;
double share_of_turns(std::size_t candidates, int round);

/// Chooses the method of a job of `auto`: its candidates are jobs with their own folders,
/// checkpoints and curves, rendered in turns with a shared scene and analysis.
///
/// After each round candidates are ranked by the squared error expected at the end of the budget;
/// the cost is time, or rays if the budget has no time limit. The chosen candidate's picture is
/// continued as the job's: it has the same bits as a job of that method after the same number of
/// iterations.
class Choosing {
 public:
  /// Continues from `choice`. Prepares the integrators of all remaining candidates; eliminates
  /// those for which the memory or the scene does not suffice. All referenced objects outlive this
  /// one. Throws the exceptions of analyse() if none is left, and transient errors.
  Choosing(const JobFolder& folder, const JobSpec& spec, Choice choice, const Prepared& prepared,
           const RunContext& context);
  ~Choosing();

  /// Runs rounds until one candidate is left. False if interrupted, with checkpoints written.
  bool run();

  const Choice& choice() const { return choice_; }
  /// After run(): the prepared integrator of the chosen candidate.
  std::unique_ptr<Integrator> take_integrator();

 private:
  class Entrant;

  std::size_t remaining() const;
  void play(int round);
  void take_turn(Entrant& entrant, const Budget& part, bool may_be_late);
  void judge();
  void leave(std::size_t k, const std::string& why);
  /// leave() for the exception in flight; rethrows it if none is left or it is transient.
  void leave_by_error(std::size_t k, const std::exception& e);
  void record();

  const JobFolder& folder_;
  const JobSpec& spec_;
  const RunContext& context_;
  Choice choice_;
  std::vector<std::unique_ptr<Entrant>> entrants_;  // of each candidate; null: eliminated
};

}  // namespace lacuna
