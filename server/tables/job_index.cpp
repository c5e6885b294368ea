#include "server/tables/job_index.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "analysis/storage/bytes.h"
#include "analysis/storage/file_handle.h"
#include "jobs/spec/version.h"
#include "server/tables/job_entry.h"

namespace lacuna {
namespace {

constexpr std::size_t buffer_bytes = 1 << 20, entries_at_once = 64;
constexpr std::uint64_t most_entry_bytes = 1 << 22;  // more is damage

std::int64_t nanoseconds(const timespec& t) { return t.tv_sec * 1'000'000'000 + t.tv_nsec; }

struct RecordHead {
  std::uint64_t bytes = 0, hash = 0;
};

template <class Visit>
void visit_texts(JobEntry& e, Visit&& visit) {
  for (std::string* text : {&e.id, &e.label, &e.scene, &e.integrator, &e.reference, &e.sweep,
                            &e.state.created, &e.state.started, &e.state.finished, &e.state.phase,
                            &e.state.error, &e.control.renderer_boot, &e.control.idempotency_key,
                            &e.control.body_hash, &e.control.shards, &e.text, &e.words}) {
    visit(*text);
  }
}

/// Plain values, in the order of the record.
template <class Visit>
void visit_values(JobEntry& e, Visit&& visit) {
  const auto each = [&](auto&... values) { (visit(values), ...); };
  each(e.stamp, e.exclusive, e.job_hash, e.revision_hash, e.pictured, e.over);
  each(e.state.state, e.state.attempts, e.state.exit_code);
  each(e.control.priority, e.control.held, e.control.cancel, e.control.crashes,
       e.control.renderer_pid, e.control.renderer_start);
}

template <class Visit>
void visit_progress(Progress& p, Visit&& visit) {
  const auto each = [&](auto&... values) { (visit(values), ...); };
  each(p.iteration, p.seconds, p.cpu_seconds, p.share);
}

std::string record(JobEntry entry) {
  ByteWriter out;
  const auto put = [&](const auto& value) { out.put(value); };
  const auto put_optional = [&](const std::optional<double>& value) {
    out.put(static_cast<std::uint8_t>(value.has_value()));
    out.put(value.value_or(0));
  };
  visit_values(entry, put);
  visit_texts(entry, [&](const std::string& text) { out.put(std::string_view(text)); });
  out.put(static_cast<std::uint64_t>(entry.state.warnings.size()));
  for (const std::string& warning : entry.state.warnings) out.put(std::string_view(warning));
  out.put(static_cast<std::uint8_t>(entry.progress.has_value()));
  if (entry.progress) {
    visit_progress(*entry.progress, put);
    put_optional(entry.progress->remaining_seconds);
    put_optional(entry.progress->error);
    out.put(std::string_view(entry.progress->error_metric));
  }
  return out.take();
}

/// Tells this program's layout from any other's: an entry with a value in each place, as bytes.
std::string header() {
  JobEntry sample;
  sample.state.warnings = {"warning"};
  sample.progress.emplace().error = 1;
  complete(sample);
  const std::string bytes = record(sample);
  return fmt::format("lacuna job index, {}, {:016x}\n", version(),
                     XXH3_64bits(bytes.data(), bytes.size()));
}

/// Throws std::runtime_error.
std::shared_ptr<JobEntry> entry_of(std::string_view bytes) {
  ByteReader in(bytes);
  auto entry = std::make_shared<JobEntry>();
  const auto get = [&](auto& value) { value = in.get<std::remove_reference_t<decltype(value)>>(); };
  const auto get_optional = [&](std::optional<double>& value) {
    const bool has = in.get<std::uint8_t>() != 0;
    const auto number = in.get<double>();
    if (has) value = number;
  };
  visit_values(*entry, get);
  visit_texts(*entry, [&](std::string& text) { text = in.get_string(); });
  for (auto n = in.get<std::uint64_t>(); n > 0; --n)
    entry->state.warnings.push_back(in.get_string());
  if (in.get<std::uint8_t>() != 0) {
    Progress& progress = entry->progress.emplace();
    visit_progress(progress, get);
    get_optional(progress.remaining_seconds);
    get_optional(progress.error);
    progress.error_metric = in.get_string();
  }
  return entry;
}

/// Writes through a buffer; the first error is kept.
class Output {
 public:
  explicit Output(const std::filesystem::path& file)
      : handle_(::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666)) {
    if (!handle_) error_ = errno;
  }
  void append(std::string_view bytes) {
    buffer_ += bytes;
    if (buffer_.size() >= buffer_bytes) flush();
  }
  /// An errno; 0: all of it is written.
  int close() {
    flush();
    if (error_ == 0 && !handle_.close()) error_ = errno;
    return error_;
  }

 private:
  void flush() {
    for (std::string_view rest = buffer_; error_ == 0 && !rest.empty();) {
      const ssize_t n = ::write(handle_.get(), rest.data(), rest.size());
      if (n < 0 && errno != EINTR) error_ = errno;
      if (n > 0) rest.remove_prefix(static_cast<std::size_t>(n));
    }
    buffer_.clear();
  }
  FileHandle handle_;
  std::string buffer_;
  int error_ = 0;
};

}  // namespace

std::int64_t file_system_time(const std::filesystem::path& folder) {
  const std::filesystem::path name = temporary_name(folder / "clock");
  const FileHandle file(::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (!file) throw_file_error(errno, "write", name);
  struct stat status {};
  const int failed = ::fstat(file.get(), &status) != 0 ? errno : 0;
  ::unlink(name.c_str());
  if (failed != 0) throw_file_error(failed, "examine", name);
  return nanoseconds(status.st_ctim);
}

std::uint64_t folder_stamp(const JobFolder& folder, std::int64_t settled_before) {
  struct File {
    std::string_view name;
    bool required;
  };
  constexpr File files[] = {
      {"", true}, {"job.json", true}, {"state.json", true}, {"queue.json", false}};
  std::array<std::int64_t, 3 * std::size(files)> facts{};
  std::string path = folder.dir().string() + '/';
  const std::size_t prefix = path.size();
  std::size_t at = 0;
  for (const auto& [name, required] : files) {
    path.resize(prefix);
    path += name;
    struct stat status {};
    if (::lstat(path.c_str(), &status) != 0) {
      if (required || errno != ENOENT) return 0;
      status = {};
    }
    const std::int64_t changed = nanoseconds(status.st_ctim);
    if (changed >= settled_before) return 0;
    facts[at++] = static_cast<std::int64_t>(status.st_ino);
    facts[at++] = name.empty() ? 0 : status.st_size;
    facts[at++] = changed;
  }
  return std::max<std::uint64_t>(1, XXH3_64bits(facts.data(), sizeof facts));
}

JobIndexReader::JobIndexReader(const std::filesystem::path& file) : buffer_(buffer_bytes) {
  in_.rdbuf()->pubsetbuf(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  in_.open(file, std::ios::binary);
  const std::string expected = header();
  std::string found(expected.size(), '\0');
  in_.read(found.data(), static_cast<std::streamsize>(found.size()));
  if (in_ && found != expected) in_.setstate(std::ios::failbit);
}

std::vector<std::shared_ptr<JobEntry>> JobIndexReader::next() {
  std::vector<std::string> records;
  {
    const std::lock_guard lock(mutex_);
    while (records.size() < entries_at_once) {
      RecordHead head;
      if (!in_.read(reinterpret_cast<char*>(&head), sizeof head)) break;
      std::string bytes(head.bytes <= most_entry_bytes ? head.bytes : 0, '\0');
      in_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
      if (!in_ || XXH3_64bits(bytes.data(), bytes.size()) != head.hash) {
        in_.setstate(std::ios::failbit);
        break;
      }
      records.push_back(std::move(bytes));
    }
  }
  std::vector<std::shared_ptr<JobEntry>> entries;
  entries.reserve(records.size());
  try {
    for (const std::string& bytes : records) entries.push_back(entry_of(bytes));
  } catch (const std::runtime_error&) {  // another program with the same header wrote it
    const std::lock_guard lock(mutex_);
    in_.setstate(std::ios::failbit);
  }
  return entries;
}

void write_job_index(const std::filesystem::path& file,
                     const std::vector<std::shared_ptr<const JobEntry>>& entries) {
  const std::filesystem::path temporary = temporary_name(file);
  Output out(temporary);
  out.append(header());
  for (const auto& entry : entries) {
    const std::string bytes = record(*entry);
    RecordHead head;
    head.bytes = bytes.size();
    head.hash = XXH3_64bits(bytes.data(), bytes.size());
    if (bytes.size() > most_entry_bytes) continue;
    out.append({reinterpret_cast<const char*>(&head), sizeof head});
    out.append(bytes);
  }
  int error = out.close();
  if (error == 0 && ::rename(temporary.c_str(), file.c_str()) != 0) error = errno;
  if (error == 0) return;
  ::unlink(temporary.c_str());
  throw_file_error(error, "write", file);
}

}  // namespace lacuna
