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

/// The part of the budget that all candidates together may have spent when one is left, and the
/// part that each may have spent at the end of `round`, counted from 0: it doubles from round to
/// round, in which half of the candidates leave (successive halving: Jamieson and Talwalkar 2016).
inline constexpr double choosing_share = 0.1;
/// The part of the budget in which a candidate has to finish its first iteration. Until one has, it
/// may take as long as it needs: a job has at least one iteration.
inline constexpr double first_iteration_share = 1.0 / 24;
double share_of_turns(std::size_t candidates, int round);

/// Chooses the method of a job of `auto`: its candidates are jobs with folders, checkpoints and
/// curves of their own, rendered in turns over one scene and one analysis.
///
/// After each round candidates are ranked by the squared error expected at the end of the budget;
/// the cost is time, or rays where the budget has no limit of time. The picture of the chosen
/// candidate goes on as that of the job: it has the bits that a job of that method has after as
/// many iterations.
class Choosing {
 public:
  /// Goes on from `choice`. Prepares the integrators of all candidates that still take turns; one
  /// for which memory or the scene does not suffice leaves. All referenced objects outlive this
  /// one. Throws what analyse() throws if none is left, and what may pass.
  Choosing(const JobFolder& folder, const JobSpec& spec, Choice choice, const Prepared& prepared,
           const RunContext& context);
  ~Choosing();

  /// Goes on until one is left. False: interrupted; checkpoints were written.
  bool run();

  const Choice& choice() const { return choice_; }
  /// After run(): the method, prepared.
  std::unique_ptr<Integrator> take_integrator();

 private:
  class Entrant;

  std::size_t remaining() const;
  void play(int round);
  void take_turn(Entrant& entrant, const Budget& part, bool may_be_late);
  void judge();
  void leave(std::size_t k, const std::string& why);
  /// The same because of the exception in flight; it goes on if none is left, or it may pass.
  void leave_by_error(std::size_t k, const std::exception& e);
  void record();

  const JobFolder& folder_;
  const JobSpec& spec_;
  const RunContext& context_;
  Choice choice_;
  std::vector<std::unique_ptr<Entrant>> entrants_;  // of each candidate; null: it has left
};

}  // namespace lacuna
