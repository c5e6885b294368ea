#pragma once

#include <mutex>
#include <random>
#include <string>
#include <vector>

#include "analysis/artefacts/cache_folder.h"
#include "analysis/artefacts/store.h"
#include "tests/analysis/artefacts/entries.h"

namespace lacuna {

using Numbers = std::vector<std::uint32_t>;

/// The artefact of these tests: noise, which does not pack, so that sizes are known.
inline Numbers noise(std::uint32_t seed, std::size_t n = 1000) {
  std::mt19937 random(seed);
  Numbers values(n);
  for (auto& v : values) v = static_cast<std::uint32_t>(random());
  return values;
}

/// A store as a process of its own has it, that counts what it does.
struct TestStore {
  explicit TestStore(const std::filesystem::path& folder, std::uint64_t byte_limit = 1 << 30,
                     double wait_seconds = 600)
      : store({.folder = folder,
               .byte_limit = byte_limit,
               .wait_seconds = wait_seconds,
               .label = "a scene",
               .message = [this](const std::string& line) { note(messages, line); },
               .warning = [this](const std::string& line) { note(warnings, line); },
               .interrupted = [this] { return interrupted && interrupted(); }}) {}

  /// The noise of `seed`, built if it must be.
  Numbers get(std::uint32_t seed) {
    const std::function<Numbers()> build = [&] {
      ++built;
      return noise(seed);
    };
    return *store.get(key_of("seed=" + std::to_string(seed)), build);
  }
  ArtefactRecord last() const { return store.records().back(); }
  void note(std::vector<std::string>& lines, const std::string& line) {
    const std::lock_guard guard(mutex);
    lines.push_back(line);
  }

  std::mutex mutex;
  int built = 0;
  std::vector<std::string> messages, warnings;
  std::function<bool()> interrupted;
  ArtefactStore store;
};

inline std::filesystem::path entry_file_of(const std::filesystem::path& folder,
                                           std::uint32_t seed) {
  return folder / entry_name(key_of("seed=" + std::to_string(seed)));
}

}  // namespace lacuna
