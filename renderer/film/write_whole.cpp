#include "renderer/film/write_whole.h"

#include <OpenImageIO/filesystem.h>
#include <fmt/format.h>

#include <new>
#include <stdexcept>

#include "analysis/storage/atomic_file.h"

namespace lacuna {

void write_whole(const std::filesystem::path& file, const char* format, const OIIO::ImageSpec& spec,
                 const OIIO::TypeDesc& type, const void* pixels) {
  const auto fail = [&](const std::string& why) {
    if (why.empty()) throw std::bad_alloc();  // no memory for a thread; all else it gives a name
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", file.string(), why));
  };
  const auto output = OIIO::ImageOutput::create(format);
  if (output == nullptr) fail(OIIO::geterror());
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  if (!output->set_ioproxy(&memory) || !output->open(file.filename().string(), spec) ||
      !output->write_image(type, pixels) || !output->close()) {
    fail(output->geterror());
  }
  write_file_atomically(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace lacuna
