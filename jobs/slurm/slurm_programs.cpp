#include "jobs/slurm/slurm_programs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

namespace lacuna {
namespace {

constexpr std::string_view waiting[] = {"PENDING",      "CONFIGURING",  "REQUEUED",
                                        "REQUEUE_FED",  "REQUEUE_HOLD", "SPECIAL_EXIT",
                                        "RESV_DEL_HOLD"};
constexpr std::string_view over[] = {"COMPLETED",     "CANCELLED", "FAILED",
                                     "TIMEOUT",       "DEADLINE",  "NODE_FAIL",
                                     "OUT_OF_MEMORY", "BOOT_FAIL", "PREEMPTED"};

// sbatch's errors for requests that this cluster can never satisfy.
constexpr std::string_view refusals[] = {
    "Requested node configuration is not available", "Memory specification can not be satisfied",
    "CPU count per node can not be satisfied",       "CPU count specification invalid",
    "More processors requested than permitted",      "Requested time limit is invalid"};

template <std::size_t N>
bool holds(const std::string_view (&words)[N], std::string_view word) {
  return std::find(std::begin(words), std::end(words), word) != std::end(words);
}

/// The first `count - 1` fields, and the rest of the line as the last: a name may contain a bar.
template <std::size_t count>
bool split(std::string_view line, std::array<std::string_view, count>& fields) {
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const auto bar = line.find('|');
    if (bar == std::string_view::npos) return false;
    fields[i] = line.substr(0, bar);
    line.remove_prefix(bar + 1);
  }
  fields[count - 1] = line;
  return true;
}

std::optional<std::int64_t> number(std::string_view text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole ? std::optional(value) : std::nullopt;
}

template <class Take>
void each_line(std::string_view text, Take&& take) {
  while (!text.empty()) {
    const auto end = std::min(text.find('\n'), text.size());
    take(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

/// The output as one line.
std::string words_of(std::string_view text) {
  std::string line;
  each_line(text, [&](std::string_view part) {
    if (part.empty()) return;
    if (!line.empty()) line += "; ";
    line += part;
  });
  constexpr std::size_t longest = 1000;
  if (line.size() > longest) line.resize(longest);
  return line;
}

}  // namespace

SlurmJob::Phase slurm_phase(std::string_view state) {
  if (holds(waiting, state)) return SlurmJob::Phase::waits;
  return holds(over, state) ? SlurmJob::Phase::over : SlurmJob::Phase::runs;
}

std::vector<SlurmJob> parse_slurm_jobs(std::string_view text) {
  std::vector<SlurmJob> jobs;
  each_line(text, [&](std::string_view line) {
    std::array<std::string_view, 5> fields;  // number, state, reason, nodes, name
    const auto id = split(line, fields) ? number(fields[0]) : std::nullopt;
    if (!id) return;  // a warning, or a task of another array
    const std::string_view state = fields[1].substr(0, fields[1].find(' '));  // "CANCELLED by 0"
    jobs.push_back({*id, std::string(fields[4]), std::string(state), std::string(fields[2]),
                    std::string(fields[3]), slurm_phase(state)});
  });
  return jobs;
}

bool refuses_the_job(std::string_view words) {
  return std::any_of(std::begin(refusals), std::end(refusals), [&](std::string_view refusal) {
    return words.find(refusal) != std::string_view::npos;
  });
}

/// The output of the program; throws SlurmError if it failed.
std::string SlurmPrograms::call(const std::vector<std::string>& words) const {
  const ProgramAnswer answer = run_(words);
  if (answer.code == 0) return answer.text;
  const std::string said = words_of(answer.text);
  throw SlurmError(said.empty() ? fmt::format("{} ended with code {}", words[0], answer.code)
                   : said.starts_with(words[0]) ? said
                                                : fmt::format("{}: {}", words[0], said));
}

std::int64_t SlurmPrograms::submit(const std::vector<std::string>& words) const {
  std::vector<std::string> all{"sbatch", "--parsable"};
  all.insert(all.end(), words.begin(), words.end());
  const std::string text = call(all);
  std::optional<std::int64_t> job;
  // The number, or number;cluster. Other lines may be advice.
  each_line(text, [&](std::string_view line) {
    if (const auto id = number(line.substr(0, line.find(';')))) job = id;
  });
  if (!job) throw SlurmError(fmt::format("sbatch returned no job number: {}", words_of(text)));
  return *job;
}

std::vector<SlurmJob> SlurmPrograms::list() const {
  return parse_slurm_jobs(
      call({"squeue", "--me", "--noheader", "--states=all", "--format=%i|%T|%r|%N|%j"}));
}

std::vector<SlurmJob> SlurmPrograms::account(const std::vector<std::string>& names) const {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ",") + name;
  try {
    return parse_slurm_jobs(
        call({"sacct", "--noheader", "--parsable2", "--allocations", "--starttime=now-30days",
              "--name=" + list, "--format=JobIDRaw,State,Reason,NodeList,JobName%128"}));
  } catch (const std::exception&) {
    return {};
  }
}

void SlurmPrograms::cancel(std::int64_t job) const { call({"scancel", std::to_string(job)}); }

void SlurmPrograms::cancel_if_waiting(std::int64_t job) const {
  call({"scancel", "--state=PENDING", std::to_string(job)});
}

void SlurmPrograms::terminate(std::int64_t job) const {
  call({"scancel", "--full", "--signal=TERM", std::to_string(job)});
}

void SlurmPrograms::set_nice(std::int64_t job, int nice) const {
  call({"scontrol", "update", fmt::format("JobId={}", job), fmt::format("Nice={}", nice)});
}

}  // namespace lacuna
