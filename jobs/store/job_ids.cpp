#include <dirent.h>
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <ctime>
#include <memory>
#include <random>

#include "base/storage/file_handle.h"
#include "jobs/store/job_folder.h"

namespace lacuna {
namespace {

/// The form of an id: 'd' a digit, 'x' a lower-case letter or digit, else itself.
constexpr std::string_view id_form = "dddddddd-dddddd-xxxxxx";
/// The digits of base 36: ids of one second sort by the numbers of their letters.
constexpr std::string_view id_letters = "0123456789abcdefghijklmnopqrstuvwxyz";
constexpr std::size_t id_time_size = id_form.find('x');

/// The number represented by the letters of an id, and the count of such numbers.
std::uint64_t letters_value(std::string_view id) {
  std::uint64_t value = 0;
  for (const char c : id.substr(id_time_size))
    value = id_letters.size() * value + id_letters.find(c);
  return value;
}
std::uint64_t letters_values() {
  std::uint64_t values = 1;
  for (std::size_t i = id_time_size; i < id_form.size(); ++i) values *= id_letters.size();
  return values;
}

/// Whether the file is of this type, or this cannot be determined now.
bool may_be(const std::filesystem::path& file, std::filesystem::file_type type) {
  std::error_code error;
  const auto found = std::filesystem::symlink_status(file, error).type();
  return found == type || found == std::filesystem::file_type::none;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::tm utc(std::chrono::system_clock::time_point t) {
  // Rounded down, before 1970 too: to_time_t() may round towards 1970.
  const std::time_t seconds =
      std::chrono::floor<std::chrono::seconds>(t).time_since_epoch().count();
  std::tm fields{};
  ::gmtime_r(&seconds, &fields);
  return fields;
}

}  // namespace

std::string new_job_id() {
  std::random_device random;
  std::uniform_int_distribution<std::size_t> letter(0, id_letters.size() - 1);
  std::string id = fmt::format("{:%Y%m%d-%H%M%S}-", utc(std::chrono::system_clock::now()));
  while (id.size() < id_form.size()) id += id_letters[letter(random)];
  return id;
}

bool is_job_id(std::string_view s) {
  return std::equal(s.begin(), s.end(), id_form.begin(), id_form.end(), [](char c, char form) {
    if (form == 'd') return is_digit(c);
    if (form == 'x') return id_letters.find(c) != std::string_view::npos;
    return c == form;
  });
}

std::string run_job_id(std::string_view sweep_id, std::size_t index) {
  std::uint64_t value = (letters_value(sweep_id) + 1 + index) % letters_values();
  std::string id(sweep_id);
  for (std::size_t i = id.size(); i-- > id_time_size; value /= id_letters.size()) {
    id[i] = id_letters[value % id_letters.size()];
  }
  return id;
}

std::optional<std::size_t> run_index(std::string_view sweep_id, std::string_view job_id) {
  if (!is_job_id(job_id)) return std::nullopt;
  if (job_id.substr(0, id_time_size) != sweep_id.substr(0, id_time_size)) return std::nullopt;
  const std::uint64_t all = letters_values();
  return (letters_value(job_id) + all - letters_value(sweep_id) + all - 1) % all;
}

std::vector<std::string> list_job_names(const std::filesystem::path& jobs) {
  std::vector<std::string> names;
  const std::unique_ptr<DIR, int (*)(DIR*)> folder(::opendir(jobs.c_str()), &::closedir);
  if (!folder) {
    if (errno == ENOENT) return names;
    throw_file_error(errno, "read", jobs);
  }
  for (;;) {
    errno = 0;
    const dirent* entry = ::readdir(folder.get());
    if (entry == nullptr && errno != 0) throw_file_error(errno, "read", jobs);
    if (entry == nullptr) break;
    if (!is_job_id(entry->d_name)) continue;
    // The directory entry mostly contains the type, which saves a stat of the file.
    bool is_folder = entry->d_type == DT_DIR;
    if (entry->d_type == DT_UNKNOWN) {
      is_folder = may_be(jobs / entry->d_name, std::filesystem::file_type::directory);
    }
    if (is_folder) names.emplace_back(entry->d_name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool is_job(const JobFolder& folder) {
  return may_be(folder.file("job.json"), std::filesystem::file_type::regular);
}

std::vector<JobFolder> list_jobs(const std::filesystem::path& jobs) {
  std::vector<JobFolder> found;
  for (const std::string& name : list_job_names(jobs)) {
    if (JobFolder folder(jobs / name); is_job(folder)) found.push_back(std::move(folder));
  }
  return found;
}

std::string utc_text(std::chrono::system_clock::time_point time) {
  const auto since_second = time - std::chrono::floor<std::chrono::seconds>(time);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", utc(time),
                     std::chrono::floor<std::chrono::milliseconds>(since_second).count());
}

std::string utc_now() { return utc_text(std::chrono::system_clock::now()); }

}  // namespace lacuna
