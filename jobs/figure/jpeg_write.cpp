#include "jobs/figure/jpeg_write.h"

#include <jpeglib.h>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

namespace lacuna {
namespace {

/// libjpeg's handler must not return. The exception passes frames of C, which Debian's libjpeg
/// allows: it is compiled with unwind tables.
[[noreturn]] void fail_jpeg(j_common_ptr info) {
  char text[JMSG_LENGTH_MAX];
  info->err->format_message(info, text);
  throw std::runtime_error(text);
}

struct JpegCompressor {
  jpeg_error_mgr errors{};
  jpeg_compress_struct info{};
  unsigned char* bytes = nullptr;
  unsigned long size = 0;

  JpegCompressor() {
    info.err = jpeg_std_error(&errors);
    errors.error_exit = fail_jpeg;
    jpeg_create_compress(&info);
    jpeg_mem_dest(&info, &bytes, &size);
  }
  JpegCompressor(const JpegCompressor&) = delete;
  JpegCompressor& operator=(const JpegCompressor&) = delete;
  ~JpegCompressor() {
    jpeg_destroy_compress(&info);
    std::free(bytes);
  }
};

}  // namespace

std::string encode_jpeg(const CodeImage& image, int quality) {
  JpegCompressor jpeg;
  jpeg.info.image_width = static_cast<JDIMENSION>(image.width);
  jpeg.info.image_height = static_cast<JDIMENSION>(image.height);
  jpeg.info.input_components = 3;
  jpeg.info.in_color_space = JCS_RGB;
  jpeg_set_defaults(&jpeg.info);
  jpeg_set_quality(&jpeg.info, quality, TRUE);
  jpeg.info.comp_info[0].h_samp_factor = jpeg.info.comp_info[0].v_samp_factor = 1;
  jpeg.info.optimize_coding = TRUE;
  jpeg_start_compress(&jpeg.info, TRUE);
  for (int y = 0; y < image.height; ++y) {
    auto* row = const_cast<JSAMPLE*>(image.rgb.data() + 3 * std::ptrdiff_t{y} * image.width);
    jpeg_write_scanlines(&jpeg.info, &row, 1);
  }
  jpeg_finish_compress(&jpeg.info);
  return {reinterpret_cast<const char*>(jpeg.bytes), jpeg.size};
}

}  // namespace lacuna
