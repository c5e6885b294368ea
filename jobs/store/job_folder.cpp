#include "jobs/store/job_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "base/storage/atomic_file.h"
#include "base/storage/file_handle.h"
#include "jobs/spec/described_json.h"
#include "jobs/spec/job_json.h"
#include "jobs/store/new_folder.h"
#include "jobs/store/own_document.h"

namespace lacuna {
namespace {

/// Text for a one-line field of outcome.json: no control characters, of bounded length.
std::string one_line(std::string text) {
  constexpr std::size_t longest = 4000;
  if (text.size() > longest) {
    text.resize(longest);
    text += "...";
  }
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return text;
}

/// Whether the file does not exist; false if this cannot be determined: reading it then throws the
/// reason.
bool is_missing(const std::filesystem::path& path) {
  return ::access(path.c_str(), F_OK) != 0 && errno == ENOENT;
}

}  // namespace

const std::vector<FileInfo>& job_files() {
  static const std::vector<FileInfo> files{
      {"job.json", "application/json", "the job with every default filled in", true},
      {"outcome.json", "application/json", "the state that its renderer reached, and how it ended",
       true},
      {"progress.json", "application/json", "progress of the renderer", true},
      {"accepted.json", "application/json", "data of the service about its acceptance", false},
      {"slurm.json", "application/json", "its submission to Slurm", false},
      {"slurm.sh", "text/x-shellscript", "the batch script of its last submission", false},
      {"slurm.exit", "text/plain", "how the renderer of that submission ended", false},
      {"image.exr", "image/x-exr", "the picture and its layers", true},
      {"image.png", "image/png", "a tone-mapped thumbnail", true},
      {"layers.half", "application/octet-stream", "the layers, for viewers that read no EXR", true},
      {"layers.json", "application/json", "index of layers.half", true},
      {"curve.csv", "text/csv", "error and counts against time", true},
      {"program.log", "text/plain", "output of another program (integrator foreign)", true},
      {"report.json", "application/json", "time and rays by phase, errors, warnings", true},
      {"checkpoint.bin", "application/octet-stream", "the state from which rendering resumes",
       false},
      {"choice.json", "application/json", "how the method of `auto` was chosen", true},
      {"inputs.json", "application/json", "the files it was made from, with their hashes", true},
      {"log.txt", "text/plain; charset=utf-8", "log of the renderers", true},
  };
  return files;
}

JobFolder JobFolder::create(const std::filesystem::path& dir, const JobSpec& spec) {
  const std::filesystem::path target = folder_path(dir);
  create_folder_whole(
      target, [&](const std::filesystem::path& draft) { JobFolder(draft).write_job(spec); });
  return JobFolder(target);
}

std::string JobFolder::read_job_text() const {
  try {
    return read_file(file("job.json"), max_job_bytes);
  } catch (const std::length_error& e) {
    throw BadJob({Problem{"", e.what()}});
  }
}

JobSpec JobFolder::read_job() const { return parse_job(read_job_text()); }

void JobFolder::write_job(const JobSpec& spec) const {
  write_file_atomically(file("job.json"), lacuna::write_job(spec));
}

JobState JobFolder::read_state() const {
  const auto path = file("outcome.json");
  if (!is_missing(path)) return read_own<JobState>(path);
  const auto older = file("state.json");  // its name until version 0.1
  return is_missing(older) ? JobState{} : read_own<JobState>(older);
}

void JobFolder::reopen() const {
  JobState state = read_state();
  state.state = State::queued;
  state.error.clear();
  state.finished.clear();
  write_state(state);
}

Acceptance JobFolder::read_acceptance() const {
  const auto path = file("accepted.json");
  return is_missing(path) ? Acceptance{} : read_own<Acceptance>(path);
}

void JobFolder::write_acceptance(const Acceptance& a) const {
  write_file_atomically(file("accepted.json"), write_document(a), false);
}

void JobFolder::write_state(const JobState& s, bool synced) const {
  JobState state = s;
  state.error = one_line(std::move(state.error));
  for (std::string& warning : state.warnings) warning = one_line(std::move(warning));
  write_file_atomically(file("outcome.json"), write_document(state), synced);
}

std::optional<Progress> JobFolder::read_progress() const {
  // Not synced: after a power failure it may be empty or missing, which means that nothing is
  // known.
  try {
    return read_own<Progress>(file("progress.json"));
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

void JobFolder::write_progress(const Progress& p) const {
  write_file_atomically(file("progress.json"), write_document(p), false);
}

std::optional<JobFolder::Lock> JobFolder::try_lock() const {
  auto lock = FileLock::try_take(file(".lock"));
  if (lock) remove_stale_temporaries(dir_);
  return lock;
}

}  // namespace lacuna
