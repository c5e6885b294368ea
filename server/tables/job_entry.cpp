#include "server/tables/job_entry.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <nlohmann/json.hpp>
#include <variant>

#include "analysis/storage/passing_error.h"
#include "jobs/spec/job_json.h"
#include "server/tables/entry_json.h"
#include "server/tables/job_index.h"

namespace lacuna {
namespace {

std::uint64_t hash(std::string_view text) { return XXH3_64bits(text.data(), text.size()); }

/// The first thing that a folder could not tell.
class Damage {
 public:
  /// Throws on what may pass.
  template <class Read>
  void try_to(Read&& read) {
    try {
      read();
    } catch (const std::exception& error) {
      if (may_pass(error)) throw;
      if (reason_.empty()) reason_ = error.what();
    }
  }
  const std::string& reason() const { return reason_; }

 private:
  std::string reason_;
};

}  // namespace

std::string JobEntry::revision() const { return fmt::format("{:016x}", revision_hash); }

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

void complete(JobEntry& entry) {
  entry.text = json_text(to_json(entry));
  entry.revision_hash =
      hash(fmt::format("{:016x} {} {} {} {}", entry.job_hash, json_text(to_json(entry.state)),
                       entry.control.priority, entry.control.held, entry.control.cancel));
  entry.words = lower_case(
      fmt::format("{}\n{}\n{}\n{}", entry.label, entry.scene, entry.integrator, entry.id));
}

void take_spec(JobEntry& entry, const JobSpec& spec, const std::string& text) {
  entry.label = spec.label;
  entry.scene = spec.scene;
  entry.integrator = std::visit([](const auto& s) { return std::string(s.name); }, spec.integrator);
  entry.reference = spec.reference;
  entry.exclusive = spec.exclusive;
  entry.job_hash = hash(text);
}

bool has_picture(const JobFolder& folder) {
  std::error_code unknown;
  return std::filesystem::exists(folder.file("image.png"), unknown);
}

std::shared_ptr<JobEntry> read_entry(const JobFolder& folder, std::int64_t settled_before) {
  auto entry = std::make_shared<JobEntry>();
  entry->id = folder.id();
  // Taken first: what changes meanwhile makes it void.
  if (settled_before != 0) entry->stamp = folder_stamp(folder, settled_before);
  Damage damage;
  damage.try_to([&] { entry->control = folder.read_control(); });
  damage.try_to([&] { entry->state = folder.read_state(); });
  damage.try_to([&] {
    const std::string text = folder.read_job_text();
    take_spec(*entry, parse_job(text), text);
  });
  entry->progress = folder.read_progress();
  entry->pictured = has_picture(folder);
  entry->over = is_terminal(entry->state.state);
  if (damage.reason().empty()) return entry;
  entry->damaged = entry->over = true;
  entry->state.state = State::failed;
  entry->state.error = fmt::format("the job's folder cannot be read: {}", damage.reason());
  return entry;
}

std::shared_ptr<JobEntry> unread_entry(const std::string& id, const std::exception& error) {
  auto entry = std::make_shared<JobEntry>();
  entry->id = id;
  entry->unread = true;
  entry->obstacle = fmt::format("the job's folder cannot be read for now: {}", error.what());
  return entry;
}

}  // namespace lacuna
