// Budgets of nothing, and of more than anybody waits for.
#include <fmt/format.h>

#include <atomic>

#include "jobs/spec/job_json.h"
#include "tests/extremes/rows.h"

namespace lacuna::extremes {
namespace {

Budget seconds(double s) {
  Budget b;
  b.seconds = s;
  return b;
}

Budget iterations(std::int64_t n) {
  Budget b;
  b.iterations = n;
  return b;
}

/// What the schema does not allow is refused where it is read, by the name of the field.
Row refused(const std::string& name, const Budget& budget, const std::string& field) {
  return {name, [=](Stage& stage, const Method& method, Check& check) {
            JobSpec job = stage.job(method, "any.glb");
            job.budget = budget;
            check.refused([&] { parse_job(write_job(job)); }, "/budget/" + field);
          }};
}

/// How often a job may ask after it was told to stop. Measured are at most 3 times, over all
/// methods: the loops on two threads and those around them.
constexpr int most_after_stop = 8;
/// How often it may ask before its first iteration is done.
constexpr int most_patience = 1'000'000;

/// The largest budget that is allowed: the job stops soon after it is told to, keeps what it has,
/// and its estimates of what remains are numbers.
Row stopped(const std::string& name, const Budget& budget) {
  return {name, [=](Stage& stage, const Method& method, Check& check) {
            const std::string& scene = stage.scene("room", [] { return room({}); });
            JobSpec job = stage.job(method, scene);
            job.budget = budget;
            parse_job(write_job(job));  // it is allowed
            // How often a method asks in its first iteration is its own affair.
            std::optional<Progress> progress;
            for (int patience = 100; !progress || progress->iteration == 0; patience *= 2) {
              std::atomic<int> asked{0};
              const std::function<bool()> impatient = [&] { return ++asked > patience; };
              const JobFolder folder = stage.run(job, impatient);
              check.require(folder.read_state().state == State::interrupted,
                            "was told to stop, and did not");
              check.require(asked <= patience + most_after_stop, "went on asking");
              progress = folder.read_progress();
              check.require(patience < most_patience, "nothing was done until then");
              if (patience >= most_patience) return;
            }
            const double used = budget.seconds
                                    ? progress->seconds / *budget.seconds
                                    : double(progress->iteration) / double(*budget.iterations);
            check.require(used > 0 && std::abs(progress->share - used) <= 1e-9 * used,
                          "a share of the budget");
            check.require(
                !progress->remaining_seconds || (std::isfinite(*progress->remaining_seconds) &&
                                                 *progress->remaining_seconds > 0),
                "what remains is not a time");
          }};
}

}  // namespace

std::vector<Row> budget_rows(const Effort&) {
  return {refused("a budget of 0 s", seconds(0), "seconds"),
          refused("a budget of 0 iterations", iterations(0), "iterations"),
          refused("a budget of 1e9 s", seconds(1e9), "seconds"),
          stopped("a budget of 1e7 s, stopped", seconds(1e7)),
          stopped("2^32 - 1 iterations, stopped", iterations(4294967295))};
}

}  // namespace lacuna::extremes
