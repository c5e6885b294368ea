#include "jobs/archive/check_archive.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>

#include "base/storage/atomic_file.h"
#include "base/storage/passing_error.h"
#include "jobs/archive/tar_zstd.h"
#include "jobs/spec/described_json.h"
#include "jobs/spec/version.h"
#include "jobs/store/machine.h"
#include "jobs/store/own_document.h"
#include "jobs/sweep/answers.h"
#include "jobs/sweep/estimate.h"

namespace lacuna {
namespace fs = std::filesystem;
namespace {

constexpr DocumentLimits manifest_limits{256 << 20, 8};

/// An archive as it was read: its manifest, and what its files are.
struct Contents {
  Manifest manifest;
  std::map<std::string, ArchivedFile> files;  ///< by name below the archive's folder
};

Contents read_archive(const fs::path& file) {
  Contents found;
  bool has_manifest = false;
  read_tar(file, [&](TarEntry& entry) {
    const std::string name = entry.name().substr(entry.name().find('/') + 1);
    if (name == "manifest.json") {
      has_manifest = true;
      try {
        found.manifest =
            read_document<Manifest>(entry.text(manifest_limits.max_bytes), manifest_limits);
      } catch (const BadJob& bad) {
        throw std::runtime_error(fmt::format("{}: {}: {}", file.string(), name, bad.what()));
      }
    } else if (name != "reproduce.sh") {
      found.files[name] = entry.measure();
    }
  });
  if (!has_manifest) {
    throw std::runtime_error(file.string() +
                             " has no manifest.json: `lacuna archive` made no such");
  }
  return found;
}

Contents read_extracted(const fs::path& manifest_file) {
  Contents found{read_own<Manifest>(manifest_file, manifest_limits), {}};
  const fs::path folder = fs::absolute(manifest_file).parent_path();
  for (const ArchivedFile& f : found.manifest.files) {
    const fs::path name = fs::path(f.name).lexically_normal();
    if (name.is_absolute() || *name.begin() == "..") {
      throw std::runtime_error(fmt::format("{}: the name \"{}\" leaves the archive's folder",
                                           manifest_file.string(), f.name));
    }
    if (!fs::exists(folder / name)) continue;
    const InputFile now = measure_input(folder / name);
    found.files[f.name] = {f.name, now.bytes, now.hash};
  }
  return found;
}

void compare_files(const Contents& contents, ArchiveCheck& check) {
  std::map<std::string, ArchivedFile> rest = contents.files;
  for (const ArchivedFile& f : contents.manifest.files) {
    const auto found = rest.find(f.name);
    if (found == rest.end()) {
      check.differences.push_back(f.name + " is missing");
      continue;
    }
    if (found->second.hash != f.hash || found->second.bytes != f.bytes) {
      check.differences.push_back(f.name + " is not the file that was archived");
    }
    rest.erase(found);
  }
  for (const auto& [name, f] : rest) check.differences.push_back(name + " is not in the manifest");
}

void compare_program(const Manifest& m, ArchiveCheck& check) {
  if (m.version != version()) {
    check.differences.push_back(
        fmt::format("rendered by Lacuna {}; this is {}", m.version, version()));
  }
  if (m.processor != processor_name() || m.cores != processor_threads()) {
    check.notes.push_back(
        fmt::format("rendered on {} with {} threads; this is {} with {}: times "
                    "differ, and perhaps last bits",
                    m.processor, m.cores, processor_name(), processor_threads()));
  }
}

/// Inputs of which the archive has the hash only.
void compare_left_out(const Manifest& m, InputCheck& inputs, ArchiveCheck& check) {
  std::string scene;
  for (const InputFile& recorded : m.left_out) {
    if (recorded.role == InputRole::scene) scene = recorded.name;
    InputFile now;
    try {
      now = inputs.now(recorded, scene);
    } catch (const InputUnreadable& e) {
      check.differences.push_back(fmt::format("{}: {}", input_text(recorded), e.what()));
      continue;
    }
    if (now == recorded) continue;
    check.differences.push_back(fmt::format(
        "{} is left out, and {}", input_text(recorded),
        now.hash.empty() ? "no scenes root has the same" : "that of the scenes root differs"));
  }
}

std::vector<double> errors_of(std::span<const ArchivedRun> runs, std::size_t cell) {
  std::vector<double> all;
  for (const ArchivedRun& r : runs) {
    if (r.cell == cell + 1 && r.error && *r.error > 0) all.push_back(*r.error);
  }
  return all;
}

void compare_results(const Manifest& m, const SweepFolder& sweep, ArchiveCheck& check) {
  const Answers answers = answer(sweep);
  if (m.metric != enum_name(answers.axes.metric)) {
    check.differences.push_back(fmt::format("its errors are {}, those of {} {}", m.metric,
                                            sweep.dir().string(), enum_name(answers.axes.metric)));
    return;
  }
  for (const CellAnswer& cell : answers.cells) {
    std::vector<double> here;
    for (const std::size_t run : cell.done) here.push_back(answers.results[run].end->error);
    const std::vector<double> there = errors_of(m.runs, cell.cell);
    const std::string text = cell_text(sweep.plan().cells[cell.cell].settings);
    if (there.empty() != here.empty()) {
      check.differences.push_back(
          fmt::format("{}: {} errors archived, {} here", text, there.size(), here.size()));
    }
    if (there.empty() || here.empty()) continue;
    const Estimate ratio = ratio_of_means(here, there);
    std::string line = fmt::format("{}: {} is {:.3g} of the archived", text, m.metric, ratio.value);
    if (ratio.interval) {
      line += fmt::format(" [{:.3g}, {:.3g}]", ratio.interval->low, ratio.interval->high);
    }
    const bool differs = ratio.interval && !may_be_equal(here, there);
    (differs ? check.differences : check.notes).push_back(std::move(line));
  }
}

}  // namespace

ArchiveCheck check_archive(const fs::path& file, InputCheck& inputs,
                           const std::optional<SweepFolder>& against) {
  const Contents contents = file.extension() == ".json" ? read_extracted(file) : read_archive(file);
  ArchiveCheck check;
  check.files = contents.manifest.files.size();
  check.runs = contents.manifest.runs.size();
  compare_files(contents, check);
  compare_program(contents.manifest, check);
  compare_left_out(contents.manifest, inputs, check);
  if (against) compare_results(contents.manifest, *against, check);
  return check;
}

}  // namespace lacuna
