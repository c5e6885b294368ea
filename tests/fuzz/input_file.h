#pragma once

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "base/storage/file_handle.h"
#include "tests/fuzz/expect.h"

namespace lacuna::fuzz {

/// A folder of this process's own below $TMPDIR, gone with the object.
class Folder {
 public:
  Folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "lacuna-fuzz-XXXXXX").string();
    expect(::mkdtemp(pattern.data()) != nullptr, "a temporary folder can be made");
    dir_ = pattern;
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(dir_, ignored);
  }
  const std::filesystem::path& dir() const { return dir_; }

 private:
  std::filesystem::path dir_;
};

/// The input as the only file of a folder, for what reads files.
class InputFile {
 public:
  explicit InputFile(std::string_view name) : file_(folder_.dir() / name) {}

  /// The path of the file, which now holds `bytes`.
  const std::filesystem::path& holding(std::span<const std::uint8_t> bytes) const {
    const FileHandle handle(::open(file_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600));
    expect(::write(handle.get(), bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()),
           "the input can be written to a file");
    return file_;
  }

 private:
  Folder folder_;
  std::filesystem::path file_;
};

}  // namespace lacuna::fuzz
