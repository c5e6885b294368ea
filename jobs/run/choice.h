#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "jobs/run/budget.h"
#include "jobs/spec/auto_settings.h"
#include "jobs/spec/job_spec.h"
#include "jobs/store/job_folder.h"

namespace lacuna {

/// Where a candidate stands after one of its turns.
struct Turn {
  std::int64_t iterations = 0;
  double seconds = 0, cpu_seconds = 0;  ///< so far, of rendering; CPU divided by threads
  double rays = 0;                      ///< so far
  std::optional<double> noise;          ///< PictureError; none: not known
  double missing = 0, bias = 0;
  std::optional<double> expected;  ///< the error at the end of the budget, were it the method
  bool operator==(const Turn&) const = default;
};
template <class V>
void describe(V& v, Turn& t) {
  v("iterations", t.iterations, {.doc = "so far", .min = 0});
  v("seconds", t.seconds, {.doc = "render time so far, wall clock", .unit = "s"});
  v("cpu_seconds", t.cpu_seconds,
    {.doc = "render time so far, CPU seconds / threads", .unit = "s"});
  v("rays", t.rays, {.doc = "rays and shadow rays so far"});
  v("noise", t.noise, {.doc = "the picture's squared error, from its halves"});
  v("missing", t.missing,
    {.doc = "squared, the light that blocks of pixels miss beside the other pictures"});
  v("bias", t.bias, {.doc = "the squared difference to the best unbiased picture, without noise"});
  v("expected", t.expected, {.doc = "squared error at the end of the budget with this method"});
}

struct Candidate {
  std::string name;
  CandidateSettings integrator;
  std::uint64_t seed = 0;  ///< of its job
  std::vector<Turn> turns;
  std::string left;  ///< why it takes no turns any more; empty: it does, or is the method
  bool operator==(const Candidate&) const = default;
};
template <class V>
void describe(V& v, Candidate& c) {
  v("name", c.name, {.doc = "the integrator and its strategies"});
  v("integrator", c.integrator, {.doc = "its settings"});
  v("seed", c.seed, {.doc = "of its random numbers", .min = 0, .max = 9007199254740991.0});
  v("turns", c.turns, {.doc = "after each round"});
  v("left", c.left, {.doc = "why it left; empty: it is still there"});
}

/// choice.json: how the method of a job of `auto` is, or was, chosen. What it says holds: a job
/// that goes on decides nothing again.
struct Choice {
  RankingMetric metric = RankingMetric::relmse;
  std::vector<Candidate> candidates;
  std::optional<int> chosen;  ///< of `candidates`; none: not yet
  bool operator==(const Choice&) const = default;
};
template <class V>
void describe(V& v, Choice& c) {
  v("metric", c.metric, {.doc = "of the errors"});
  v("candidates", c.candidates, {.doc = "all of them, in the order of their turns"});
  v("chosen", c.chosen, {.doc = "which is the method, from 0; null: not chosen yet", .min = 0});
}

/// The choice before the first turn.
Choice new_choice(const JobSpec& job);
/// choice.json of a job's folder; none if there is no such file. Throws std::runtime_error: it is
/// corrupt; std::system_error.
std::optional<Choice> read_choice(const JobFolder& folder);
void write_choice(const JobFolder& folder, const Choice& choice);  ///< synced

/// Of candidate `k`: its job, and the folder of it below that of `auto`.
JobSpec candidate_job(const JobSpec& job, const Candidate& candidate);
JobFolder candidate_folder(const JobFolder& folder, const Choice& choice, std::size_t k);

/// Of the chosen candidate, and what was spent on the others.
JobFolder chosen_folder(const JobFolder& folder, const Choice& choice);
Spent spent_elsewhere(const Choice& choice);

/// The job with the method that was chosen; `job` itself if it is not of `auto`. None: not chosen
/// yet.
std::optional<JobSpec> chosen_job(const JobSpec& job, const std::optional<Choice>& choice);

}  // namespace lacuna
