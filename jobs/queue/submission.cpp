#include "jobs/queue/submission.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <random>
#include <string_view>
#include <system_error>

#include "base/storage/atomic_file.h"
#include "base/storage/file_handle.h"
#include "jobs/store/own_document.h"

namespace lacuna {
namespace {

constexpr std::string_view record_file = "slurm.json", exit_file = "slurm.exit";

bool is_there(const std::filesystem::path& file) { return ::access(file.c_str(), F_OK) == 0; }

void remove_file(const std::filesystem::path& file) {
  if (::unlink(file.c_str()) != 0 && errno != ENOENT) throw_file_error(errno, "remove", file);
}

}  // namespace

std::string new_submission_name(const JobFolder& folder) {
  constexpr std::string_view letters = "0123456789abcdefghijklmnopqrstuvwxyz";
  std::random_device random;
  std::uniform_int_distribution<std::size_t> any(0, letters.size() - 1);
  constexpr std::size_t longest = 64;
  std::string name = fmt::format("lacuna-{}-", folder.id().substr(0, longest));
  // A person may have named the folder: replace characters that JSON would escape.
  for (char& c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!plain && c != '.' && c != '_') c = '-';
  }
  for (int i = 0; i < 8; ++i) name += letters[any(random)];
  return name;
}

bool has_submission(const JobFolder& folder) { return is_there(folder.file(record_file)); }

std::optional<Submission> read_submission(const JobFolder& folder) {
  if (!has_submission(folder) && errno == ENOENT) return std::nullopt;
  return read_own<Submission>(folder.file(record_file));
}

void write_submission(const JobFolder& folder, const Submission& submission) {
  write_file_atomically(folder.file(record_file), write_document(submission));
}

std::optional<int> read_submission_exit(const JobFolder& folder, const std::string& name) {
  constexpr std::size_t longest = 256;
  if (!is_there(folder.file(exit_file))) return std::nullopt;
  std::string text;
  try {
    text = read_file(folder.file(exit_file), longest);
  } catch (const std::exception&) {  // it is read again later, or Slurm reports the end
    return std::nullopt;
  }
  if (!text.starts_with(name + " ")) return std::nullopt;
  int code = 0;
  const char* begin = text.data() + name.size() + 1;
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), code);
  return error == std::errc() && end != begin ? std::optional(code) : std::nullopt;
}

void forget_submission(const JobFolder& folder) {
  remove_file(folder.file(record_file));
  remove_file(folder.file(exit_file));
}

}  // namespace lacuna
