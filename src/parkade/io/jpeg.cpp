// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/jpeg.hpp"

#include <turbojpeg.h>

#include <memory>
#include <opencv2/core.hpp>

namespace parkade {
namespace {

struct Destroy {
  void operator()(void* decoder) const { tjDestroy(decoder); }
};

}  // namespace

Result<std::optional<cv::Mat>> decodeJpeg(std::string_view bytes, bool gray) {
  // One for each thread: they keep tables and buffers.
  thread_local const std::unique_ptr<void, Destroy> kDecoder(tjInitDecompress());
  tjhandle decoder = kDecoder.get();
  if (decoder == nullptr) return Error{tjGetErrorStr2(nullptr)};
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());  // NOLINT
  int width = 0;
  int height = 0;
  int subsampling = 0;
  int colours = 0;
  if (tjDecompressHeader3(decoder, data, bytes.size(), &width, &height, &subsampling, &colours) !=
      0) {
    return Error{tjGetErrorStr2(decoder)};
  }
  if (colours == TJCS_CMYK || colours == TJCS_YCCK) return std::optional<cv::Mat>();
  cv::Mat image(height, width, gray ? CV_8UC1 : CV_8UC3);
  const int failed =
      tjDecompress2(decoder, data, bytes.size(), image.data, width, static_cast<int>(image.step),
                    height, gray ? TJPF_GRAY : TJPF_BGR, TJFLAG_ACCURATEDCT);
  // After a warning the picture is whole.
  if (failed != 0 && tjGetErrorCode(decoder) != TJERR_WARNING) {
    return Error{tjGetErrorStr2(decoder)};
  }
  return std::optional<cv::Mat>(std::move(image));
}

}  // namespace parkade
