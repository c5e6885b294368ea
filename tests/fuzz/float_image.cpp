#include "renderer/core/scene_error.h"
#include "renderer/images/image_read.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/target.h"

// An OpenEXR, Radiance HDR or TIFF file, as references and environments are: refused, or an image
// of the size it says, for the picture itself and for a layer.

namespace lacuna::fuzz {
namespace {

void read(const std::filesystem::path& file, const std::string& layer) {
  try {
    const FloatImage image =
        layer.empty() ? read_reference_image(file) : read_float_image(file, layer);
    expect(image.width > 0 && image.height > 0, "an image has pixels");
    expect(image.rgb.size() == 3 * std::size_t(image.width) * std::size_t(image.height),
           "and three values a pixel");
    require_radiance(image, "input");
  } catch (const SceneError&) {
  }
}

}  // namespace
}  // namespace lacuna::fuzz

LACUNA_FUZZ_TARGET(float_image) {
  using namespace lacuna::fuzz;
  static const InputFile input("input.exr");
  const std::string layer = "half_a";
  const auto& file = input.holding({data, size});
  read(file, "");
  // Decoding is slow: only where there may be such a layer.
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (text.find(layer) != std::string_view::npos) read(file, layer);
  return 0;
}
