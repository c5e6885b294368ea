#include "jobs/archive/tar_zstd.h"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "base/storage/checksum.h"

namespace lacuna {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t block = 1 << 16;

using EntryHandle = std::unique_ptr<archive_entry, void (*)(archive_entry*)>;

ArchivedFile summary(const std::string& name, std::uint64_t bytes, const Checksum& sum) {
  return {name, bytes, fmt::format("{:016x}", sum.value())};
}

[[noreturn]] void fail_on(archive* a, const fs::path& file) {
  const char* why = archive_error_string(a);
  throw std::runtime_error(fmt::format("{}: {}", file.string(), why == nullptr ? "no tar" : why));
}

class OpenEntry final : public TarEntry {
 public:
  OpenEntry(archive* a, const fs::path& file, std::string name)
      : archive_(a), file_(file), name_(std::move(name)) {}

  const std::string& name() const override { return name_; }
  std::string text(std::size_t max_bytes) override {
    std::string all;
    read([&](std::span<const char> part) {
      if (all.size() + part.size() > max_bytes) {
        throw std::runtime_error(
            fmt::format("{}: {} has more than {} bytes", file_.string(), name_, max_bytes));
      }
      all.append(part.data(), part.size());
    });
    return all;
  }
  ArchivedFile measure() override {
    Checksum sum;
    std::uint64_t bytes = 0;
    read([&](std::span<const char> part) {
      sum.add(part.data(), part.size());
      bytes += part.size();
    });
    return summary(name_, bytes, sum);
  }

 private:
  template <class Take>
  void read(Take&& take) {
    std::array<char, block> buffer;
    for (;;) {
      const auto got = archive_read_data(archive_, buffer.data(), buffer.size());
      if (got < 0) fail_on(archive_, file_);
      if (got == 0) return;
      take(std::span<const char>(buffer.data(), static_cast<std::size_t>(got)));
    }
  }

  archive* archive_;
  const fs::path& file_;
  std::string name_;
};

}  // namespace

TarWriter::TarWriter(fs::path file)
    : file_(std::move(file)),
      draft_(file_.string() + ".part"),
      archive_(archive_write_new(), archive_write_free) {
  if (!archive_) throw std::bad_alloc();
  archive* a = archive_.get();
  const bool ready = archive_write_add_filter_zstd(a) == ARCHIVE_OK &&
                     archive_write_set_format_pax_restricted(a) == ARCHIVE_OK &&
                     archive_write_open_filename(a, draft_.c_str()) == ARCHIVE_OK;
  if (!ready) fail();
}

TarWriter::~TarWriter() {
  archive_.reset();
  std::error_code ignored;
  fs::remove(draft_, ignored);
}

void TarWriter::fail() const { fail_on(archive_.get(), draft_); }

void TarWriter::begin(const std::string& name, std::uint64_t bytes, bool executable) {
  const EntryHandle entry(archive_entry_new(), archive_entry_free);
  if (!entry) throw std::bad_alloc();
  archive_entry_set_pathname(entry.get(), name.c_str());
  archive_entry_set_size(entry.get(), static_cast<la_int64_t>(bytes));
  archive_entry_set_filetype(entry.get(), AE_IFREG);
  archive_entry_set_perm(entry.get(), executable ? 0755 : 0644);
  if (archive_write_header(archive_.get(), entry.get()) != ARCHIVE_OK) fail();
}

void TarWriter::write(std::span<const char> part) {
  const auto written = archive_write_data(archive_.get(), part.data(), part.size());
  if (written != static_cast<la_ssize_t>(part.size())) fail();
}

ArchivedFile TarWriter::add_file(const std::string& name, const fs::path& from) {
  std::ifstream in(from, std::ios::binary);
  if (!in) throw std::system_error(errno, std::generic_category(), from.string());
  const std::uint64_t bytes = fs::file_size(from);
  begin(name, bytes, false);
  Checksum sum;
  std::vector<char> buffer(block);
  std::uint64_t done = 0;
  while (done < bytes) {
    in.read(buffer.data(),
            static_cast<std::streamsize>(std::min<std::uint64_t>(block, bytes - done)));
    const auto got = static_cast<std::size_t>(in.gcount());
    if (got == 0) throw std::runtime_error(from.string() + " was cut short while it was read");
    write({buffer.data(), got});
    sum.add(buffer.data(), got);
    done += got;
  }
  return summary(name, bytes, sum);
}

void TarWriter::add_text(const std::string& name, std::string_view text, bool executable) {
  begin(name, text.size(), executable);
  write(text);
}

void TarWriter::finish() {
  if (archive_write_close(archive_.get()) != ARCHIVE_OK) fail();
  fs::rename(draft_, file_);
}

void read_tar(const fs::path& file, const std::function<void(TarEntry&)>& each) {
  constexpr int most = 1'000'000;
  const std::unique_ptr<archive, int (*)(archive*)> a(archive_read_new(), archive_read_free);
  if (!a) throw std::bad_alloc();
  const bool ready = archive_read_support_filter_zstd(a.get()) == ARCHIVE_OK &&
                     archive_read_support_format_tar(a.get()) == ARCHIVE_OK &&
                     archive_read_open_filename(a.get(), file.c_str(), block) == ARCHIVE_OK;
  if (!ready) fail_on(a.get(), file);
  archive_entry* entry = nullptr;
  int entries = 0;
  for (;;) {
    const int result = archive_read_next_header(a.get(), &entry);
    if (result == ARCHIVE_EOF) return;
    if (result != ARCHIVE_OK) fail_on(a.get(), file);
    if (++entries > most) {
      throw std::runtime_error(fmt::format("{} has more than {} entries", file.string(), most));
    }
    const char* name = archive_entry_pathname(entry);
    if (name == nullptr || archive_entry_filetype(entry) != AE_IFREG) continue;
    OpenEntry open(a.get(), file, name);
    each(open);
  }
}

}  // namespace lacuna
