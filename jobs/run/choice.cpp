#include "jobs/run/choice.h"

#include <fmt/format.h>

#include "base/storage/atomic_file.h"
#include "jobs/run/candidates.h"
#include "jobs/spec/described_json.h"

namespace lacuna {

namespace {

constexpr std::size_t most_bytes = 4 << 20;
constexpr int most_levels = 16;
constexpr std::uint64_t seed_mask = (std::uint64_t{1} << 53) - 1;  // of JobSpec::seed

}  // namespace

Choice new_choice(const JobSpec& job) {
  const auto& settings = std::get<AutoSettings>(job.integrator);
  Choice choice;
  choice.metric = settings.metric;
  for (const CandidateSettings& c : candidates(settings)) {
    // With equal seeds pictures are not independent, and their difference does not estimate the
    // error.
    const std::uint64_t number = choice.candidates.size();
    const std::uint64_t seed = (job.seed ^ (number * 0x9E3779B97F4A7C15)) & seed_mask;
    choice.candidates.push_back({candidate_name(c), c, seed, {}, {}});
  }
  if (choice.candidates.size() == 1) choice.chosen = 0;
  return choice;
}

std::optional<Choice> read_choice(const JobFolder& folder) {
  const auto file = folder.file("choice.json");
  if (!std::filesystem::exists(file)) return std::nullopt;
  try {
    auto choice = read_document<Choice>(read_file(file, most_bytes), {most_bytes, most_levels});
    const auto count = choice.candidates.size();
    if (count == 0 || (choice.chosen && std::size_t(*choice.chosen) >= count)) {
      throw std::runtime_error("the chosen candidate does not exist");
    }
    return choice;
  } catch (const std::system_error&) {
    throw;
  } catch (const std::exception& e) {
    throw std::runtime_error(fmt::format("{}: {}", file.string(), e.what()));
  }
}

void write_choice(const JobFolder& folder, const Choice& choice) {
  write_file_atomically(folder.file("choice.json"), write_document(choice));
}

JobSpec candidate_job(const JobSpec& job, const Candidate& candidate) {
  JobSpec spec = job;
  std::visit([&](const auto& settings) { spec.integrator = settings; }, candidate.integrator);
  spec.seed = candidate.seed;
  return spec;
}

JobFolder candidate_folder(const JobFolder& folder, const Choice& choice, std::size_t k) {
  const std::string_view method =
      std::visit([](const auto& s) { return s.name; }, choice.candidates[k].integrator);
  return JobFolder(folder.file("candidates") / fmt::format("{:02}-{}", k + 1, method));
}

JobFolder chosen_folder(const JobFolder& folder, const Choice& choice) {
  return candidate_folder(folder, choice, std::size_t(*choice.chosen));
}

Spent spent_elsewhere(const Choice& choice) {
  Spent sum;
  for (std::size_t k = 0; k < choice.candidates.size(); ++k) {
    const std::vector<Turn>& turns = choice.candidates[k].turns;
    if (choice.chosen == int(k) || turns.empty()) continue;
    sum.seconds += turns.back().seconds;
    sum.cpu_seconds += turns.back().cpu_seconds;
  }
  return sum;
}

std::optional<JobSpec> chosen_job(const JobSpec& job, const std::optional<Choice>& choice) {
  if (!std::holds_alternative<AutoSettings>(job.integrator)) return job;
  if (!choice || !choice->chosen) return std::nullopt;
  return candidate_job(job, choice->candidates[std::size_t(*choice->chosen)]);
}

}  // namespace lacuna
