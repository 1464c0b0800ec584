#include "sensors/messages/jpeg_decoder.hpp"

#include <memory>
#include <string_view>

#include <turbojpeg.h>

#include "sensors/messages/byte_reader.hpp"

namespace alight {
namespace {

/// One a thread: it holds buffers that are worth keeping.
tjhandle decompressor() {
  struct Destroy {
    void operator()(void* handle) const { tjDestroy(handle); }
  };
  thread_local const std::unique_ptr<void, Destroy> handle(tjInitDecompress());
  if (!handle) throw DecodeError("JPEG: out of memory");
  return handle.get();
}

/// Cheap cameras pad their pictures; nothing of the picture is lost.
bool is_harmless(tjhandle handle) {
  return tjGetErrorCode(handle) == TJERR_WARNING &&
         std::string_view(tjGetErrorStr2(handle)).find("extraneous bytes") != std::string_view::npos;
}

void require(int result, tjhandle handle) {
  if (result != 0 && !is_harmless(handle)) throw DecodeError(std::string("JPEG: ") + tjGetErrorStr2(handle));
}

}  // namespace

bool is_jpeg(const std::uint8_t* data, std::size_t size) {
  return size >= 3 && data[0] == 0xFF && data[1] == 0xD8 && data[2] == 0xFF;
}

cv::Mat decode_jpeg(const std::uint8_t* data, std::size_t size, int max_side_px) {
  const tjhandle handle = decompressor();
  int width_px = 0;
  int height_px = 0;
  int subsampling = 0;
  int colours = 0;
  require(tjDecompressHeader3(handle, data, size, &width_px, &height_px, &subsampling, &colours), handle);
  if (width_px > max_side_px || height_px > max_side_px)
    throw DecodeError("JPEG of " + std::to_string(width_px) + "x" + std::to_string(height_px) + " pixels");
  if (colours == TJCS_CMYK || colours == TJCS_YCCK) throw DecodeError("JPEG in CMYK");
  const bool grey = colours == TJCS_GRAY;
  cv::Mat image(height_px, width_px, grey ? CV_8UC1 : CV_8UC3);
  require(tjDecompress2(handle, data, size, image.data, width_px, static_cast<int>(image.step), height_px,
                        grey ? TJPF_GRAY : TJPF_BGR, 0),
          handle);
  return image;
}

}  // namespace alight
