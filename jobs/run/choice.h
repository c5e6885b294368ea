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

/// The state of a candidate after one of its turns.
struct Turn {
  std::int64_t iterations = 0;
  double seconds = 0, cpu_seconds = 0;  ///< render time so far; CPU divided by threads
  double rays = 0;                      ///< so far
  std::optional<double> noise;          ///< PictureError; none: unknown
  double missing = 0, bias = 0;
  std::optional<double> expected;  ///< predicted error at the end of the budget
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
    {.doc = "squared deficit of light in blocks of pixels against the other pictures"});
  v("bias", t.bias,
    {.doc = "squared difference to the best unbiased picture, less the noise of both"});
  v("expected", t.expected,
    {.doc = "predicted squared error at the end of the budget with this method"});
}

struct Candidate {
  std::string name;
  CandidateSettings integrator;
  std::uint64_t seed = 0;  ///< of its job
  std::vector<Turn> turns;
  std::string left;  ///< why it was eliminated; empty: it was not, or is the method
  bool operator==(const Candidate&) const = default;
};
template <class V>
void describe(V& v, Candidate& c) {
  v("name", c.name, {.doc = "the integrator and its strategies"});
  v("integrator", c.integrator, {.doc = "its settings"});
  v("seed", c.seed, {.doc = "of its random numbers", .min = 0, .max = 9007199254740991.0});
  v("turns", c.turns, {.doc = "after each round"});
  v("left", c.left, {.doc = "why it was eliminated; empty: it was not"});
}

/// choice.json: the choice of a method for a job of `auto`. Resumed jobs keep its decisions.
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
  v("chosen", c.chosen, {.doc = "index of the chosen one, from 0; null: not chosen yet", .min = 0});
}

/// The choice before the first turn.
Choice new_choice(const JobSpec& job);
/// choice.json of a job's folder; none if there is no such file. Throws std::runtime_error if it is
/// corrupt; std::system_error.
std::optional<Choice> read_choice(const JobFolder& folder);
void write_choice(const JobFolder& folder, const Choice& choice);  ///< synced

/// The job of a candidate, and its folder below that of the job of `auto`.
JobSpec candidate_job(const JobSpec& job, const Candidate& candidate);
JobFolder candidate_folder(const JobFolder& folder, const Choice& choice, std::size_t k);

/// The folder of the chosen candidate, and the cost of the others.
JobFolder chosen_folder(const JobFolder& folder, const Choice& choice);
Spent spent_elsewhere(const Choice& choice);

/// The job with the chosen method; `job` itself if it is not of `auto`. None: not chosen yet.
std::optional<JobSpec> chosen_job(const JobSpec& job, const std::optional<Choice>& choice);

}  // namespace lacuna
