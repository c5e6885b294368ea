#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "analysis/artefacts/cache_folder.h"
#include "jobs/cli/commands.h"
#include "jobs/spec/byte_size.h"
#include "jobs/store/job_folder.h"

namespace lacuna {

namespace {

struct CacheOptions {
  std::filesystem::path folder;
  double older_than = 0;  ///< days
};

std::filesystem::path folder_of(const CacheOptions& o) {
  return o.folder.empty() ? DataRoot::from_environment().cache() : o.folder;
}

/// Escapes text from a file, which may contain anything, for one line of a terminal.
std::string on_a_line(std::string text) {
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  std::replace_if(text.begin(), text.end(), is_control, '?');
  return text;
}

std::string count_text(std::size_t entries, std::uint64_t bytes) {
  return fmt::format("{} {}, {}", entries, entries == 1 ? "artefact" : "artefacts",
                     byte_size_text(bytes));
}

void list(const CacheOptions& o) {
  fmt::print("{:<20} {:>10}  {:<24}  {:<32}  {}\n", "TYPE", "SIZE", "LAST USED", "KEY",
             "OF  SETTINGS AND INPUTS");
  std::uint64_t bytes = 0;
  const auto entries = list_cache(folder_of(o), CacheCheck::headers);
  for (const CacheEntry& e : entries) {
    bytes += e.bytes;
    const std::string about = e.refusal ? e.refusal->text : e.header.label + "  " + e.header.key;
    fmt::print("{:<20} {:>10}  {:<24}  {:<32}  {}\n", e.refusal ? "?" : on_a_line(e.header.type),
               byte_size_text(e.bytes), utc_text(e.used), e.file.stem().string(), on_a_line(about));
  }
  fmt::print("{} in {}\n", count_text(entries.size(), bytes), folder_of(o).string());
}

int verify(const CacheOptions& o) {
  std::size_t damaged = 0;
  std::uint64_t bytes = 0;
  const auto entries = list_cache(folder_of(o), CacheCheck::checksums);
  for (const CacheEntry& e : entries) {
    bytes += e.bytes;
    if (!e.refusal) continue;
    ++damaged;
    fmt::print("{}: {}\n", e.file.string(), on_a_line(e.refusal->text));
  }
  fmt::print("{} in {}: ", count_text(entries.size(), bytes), folder_of(o).string());
  if (damaged == 0) {
    fmt::print("all intact\n");
    return exit_done;
  }
  fmt::print("{} damaged; rebuilt at the next request\n", damaged);
  return exit_error;
}

void clear(const CacheOptions& o) {
  const std::chrono::duration<double, std::ratio<86400>> unused(o.older_than);
  const CacheRemoval removed =
      clear_cache(folder_of(o), std::chrono::duration_cast<std::chrono::seconds>(unused));
  fmt::print("removed {} from {}\n", count_text(removed.entries, removed.bytes),
             folder_of(o).string());
}

}  // namespace

void add_cache(CLI::App& app, int& code) {
  const auto o = std::make_shared<CacheOptions>();
  CLI::App* command = app.add_subcommand(
      "cache", "List, verify and clear the cache of artefacts, the results of scene analysis");
  command->require_subcommand(1);
  const auto add = [&](const char* name, const char* doc, const std::function<int()>& action) {
    CLI::App* sub = command->add_subcommand(name, doc);
    sub->add_option("--cache", o->folder,
                    "folder of the cache (default: LACUNA_CACHE, or cache in LACUNA_DATA)");
    sub->callback([action, &code] { code = action(); });
    return sub;
  };
  add("list", "List the artefacts, most recently used first", [o] {
    list(*o);
    return exit_done;
  });
  add("verify", "Read and verify every artefact; exit code 1 if one is damaged",
      [o] { return verify(*o); });
  add("clear", "Remove the artefacts; running jobs are not affected",
      [o] {
        clear(*o);
        return exit_done;
      })
      ->add_option("--older-than", o->older_than, "only artefacts not used for this many days")
      ->check(CLI::Range(0.0, 36'500.0));
}

}  // namespace lacuna
