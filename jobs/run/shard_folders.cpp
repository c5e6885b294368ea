#include "jobs/run/shard_folders.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>

#include "base/storage/atomic_file.h"
#include "base/storage/passing_error.h"
#include "jobs/run/checkpoint.h"
#include "jobs/spec/described_json.h"
#include "jobs/spec/job_json.h"
#include "jobs/spec/problems.h"
#include "jobs/store/inputs.h"
#include "jobs/store/new_folder.h"

namespace lacuna {

namespace {

/// The keys in which shards of one job may differ.
constexpr auto not_in_a_merge = std::to_array<std::string_view>({
    "label",               // for people
    "shard",               // which shard
    "threads",             // how many
    "checkpoint_seconds",  // when to save
    "exclusive",           // what else runs meanwhile
});

class Reader {
 public:
  void read(const std::filesystem::path& named) {
    const JobFolder folder(folder_path(named));
    try {
      read(folder);
    } catch (const std::exception& e) {
      if (may_pass(e)) throw;  // transient: its content is unknown
      refuse(folder, e.what());
    }
  }

  std::vector<Shard> take() {
    if (problems_.empty()) find_missing();
    throw_if_any(std::move(problems_));
    std::vector<Shard> shards;
    shards.reserve(shards_.size());
    for (auto& [number, shard] : shards_) shards.push_back(std::move(shard));
    return shards;
  }

 private:
  void read(const JobFolder& folder) {
    Shard shard{folder, folder.read_job(), 0, {}};
    const int number = shard.spec.shard;
    if (number == 0) return refuse(folder, "a whole job; allowed: its shards (--shard K/N)");
    const JobState state = folder.read_state();
    if (state.state != State::done) {
      const std::string reason = state.error.empty() ? "" : fmt::format(" ({})", state.error);
      return refuse(folder,
                    fmt::format("shard {} of {} is {}, not done{}; `lacuna render` continues it",
                                number, shard.spec.shards, enum_name(state.state), reason));
    }
    constexpr std::size_t most_bytes = 1 << 24;
    std::vector<Problem> problems;
    const Json report = parse_document(read_file(folder.file("report.json"), most_bytes),
                                       {most_bytes, max_json_depth}, problems);
    throw_if_any(std::move(problems));
    shard.iterations = report.at("counts").at("iterations").get<std::uint64_t>();
    shard.processor = report.at("machine").at("processor").get<std::string>();
    const CheckpointKey key = read_checkpoint_key(folder.file("checkpoint.bin"));
    const InputList inputs = read_inputs(folder).value_or(InputList{});
    if (shards_.empty()) {
      first_ = folder.dir();
      job_ = ObjectWriter::value_of(shard.spec);
      key_ = key;
      inputs_ = inputs;
    } else if (!is_same(folder, ObjectWriter::value_of(shard.spec), key, inputs)) {
      return;
    }
    const auto [there, is_new] = shards_.emplace(number, std::move(shard));
    if (is_new) return;
    refuse(folder, fmt::format("shard {} of {} is a duplicate of {}; allowed: each once", number,
                               there->second.spec.shards, there->second.folder.dir().string()));
  }

  bool is_same(const JobFolder& folder, const OrderedJson& job, const CheckpointKey& key,
               const InputList& inputs) {
    const std::size_t before = problems_.size();
    for (const auto& [name, value] : job.items()) {
      const bool counts =
          std::find(not_in_a_merge.begin(), not_in_a_merge.end(), name) == not_in_a_merge.end();
      if (counts) compare(folder, name, json_text(value), json_text(job_.at(name)));
    }
    const auto changes = changed_inputs(inputs_, inputs);
    for (const std::string& change : changes) {
      refuse(folder, fmt::format("{} in {}; allowed: shards with the same input files", change,
                                 first_.string()));
    }
    if (changes.empty()) compare(folder, "the hash of the scene", key.scene, key_.scene);
    compare(folder, "the version", key.version, key_.version);
    compare(folder, "the integrator's layers", key.layers, key_.layers);
    return problems_.size() == before;
  }

  void compare(const JobFolder& folder, const std::string& what, const std::string& value,
               const std::string& of_first) {
    if (value == of_first) return;
    refuse(folder,
           fmt::format("{} is {}; allowed: {}, as in {}", what, value, of_first, first_.string()));
  }

  void find_missing() {
    if (shards_.empty()) return;
    const int count = shards_.begin()->second.spec.shards;
    constexpr std::size_t most = 20;  // named
    std::vector<int> missing;
    for (int number = 1; number <= count; ++number) {
      if (!shards_.contains(number)) missing.push_back(number);
    }
    if (missing.empty()) return;
    const std::size_t more = missing.size() - std::min(most, missing.size());
    missing.resize(missing.size() - more);
    problems_.push_back(
        {"", fmt::format("missing shards of {}: {}{}", count, fmt::join(missing, ", "),
                         more > 0 ? fmt::format(" and {} more", more) : "")});
  }

  void refuse(const JobFolder& folder, const std::string& why) {
    problems_.push_back({"", fmt::format("{}: {}", folder.dir().string(), why)});
  }

  std::map<int, Shard> shards_;
  std::filesystem::path first_;  // the folder to which the others are compared
  OrderedJson job_;
  CheckpointKey key_;
  InputList inputs_;  // of the first; empty: not recorded
  std::vector<Problem> problems_;
};

}  // namespace

std::vector<Shard> read_shards(const std::vector<std::filesystem::path>& folders) {
  Reader reader;
  for (const auto& folder : folders) reader.read(folder);
  return reader.take();
}

std::optional<std::vector<Shard>> shards_to_merge(const JobFolder& folder) {
  const std::string sweep = folder.read_acceptance().shards;
  if (sweep.empty() || std::filesystem::exists(folder.file("checkpoint.bin"))) return std::nullopt;
  const auto count = static_cast<std::size_t>(folder.read_job().shards);
  std::vector<std::filesystem::path> folders;
  for (std::size_t i = 0; i < count; ++i) {
    folders.push_back(folder.dir().parent_path() / run_job_id(sweep, i));
  }
  return read_shards(folders);
}

}  // namespace lacuna
