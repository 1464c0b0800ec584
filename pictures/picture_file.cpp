#include "pictures/picture_file.hpp"

#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "foundation/errors.hpp"

namespace alight {

void write_picture(const std::filesystem::path& path, const cv::Mat& picture,
                   std::optional<int> png_compression) {
  std::vector<int> options;
  if (png_compression) options = {cv::IMWRITE_PNG_COMPRESSION, *png_compression};
  std::string reason;
  try {
    if (cv::imwrite(path.string(), picture, options)) return;
  } catch (const cv::Exception& e) {
    reason = " (" + e.err + ")";
  }
  throw DataError(
      path.string() + ": cannot be written" + reason +
      "; name a picture file, as .png, in a folder that exists, and check its rights and the free space");
}

}  // namespace alight
