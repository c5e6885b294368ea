#include "renderer/scene/exr_guard.h"

#include <cstdint>
#include <fstream>
#include <string>

#include "renderer/scene/scene_data.h"

namespace lacuna {
namespace {

// OpenEXR File Layout: magic, version, then for each part attributes until an empty name; where
// there are several parts, an empty header ends them.
constexpr std::uint32_t several_parts = 0x1000;
constexpr std::size_t longest_name = 255;

class Header {
 public:
  explicit Header(const std::filesystem::path& file)
      : file_(file), size_(std::filesystem::file_size(file)), stream_(file, std::ios::binary) {}

  void check() {
    integer();  // the magic
    const bool parts = (integer() & several_parts) != 0;
    for (bool first = true; check_attributes(first) && parts; first = false) {
    }
  }

 private:
  /// Up to the empty name that ends a header. False if there was none before it.
  bool check_attributes(bool first) {
    bool any = false;
    for (std::string name = text(); !name.empty(); name = text()) {
      any = true;
      const std::string type = text();
      const std::uint32_t bytes = integer();
      const auto at = static_cast<std::uintmax_t>(stream_.tellg());
      if (bytes > size_ - at) {
        fail("attribute \"" + printable(name) + "\" (" + printable(type) + ") has " +
             std::to_string(bytes) + " bytes; the file ends after " + std::to_string(size_ - at));
      }
      stream_.seekg(bytes, std::ios::cur);
    }
    if (first && !any) fail("there are no attributes");
    return any;
  }

  std::uint32_t integer() {
    std::uint32_t value = 0;  // x86-64 is little-endian, as is OpenEXR
    if (!stream_.read(reinterpret_cast<char*>(&value), sizeof value)) fail("the file ends in it");
    return value;
  }

  std::string text() {
    std::string value;
    for (int c = stream_.get(); c != 0; c = stream_.get()) {
      if (!stream_) fail("the file ends in it");
      if (value.size() == longest_name) {
        fail("a name is longer than " + std::to_string(longest_name) + " bytes");
      }
      value.push_back(static_cast<char>(c));
    }
    return value;
  }

  static std::string printable(std::string s) {
    for (char& c : s) c = c >= 0x20 && c < 0x7f ? c : '?';
    return s;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw SceneError(file_.string() + ": OpenEXR header: " + what);
  }

  const std::filesystem::path& file_;
  std::uintmax_t size_;
  std::ifstream stream_;
};

}  // namespace

void check_exr_header(const std::filesystem::path& file) { Header(file).check(); }

}  // namespace lacuna
