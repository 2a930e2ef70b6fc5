// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/jpeg.hpp"

#include <fmt/core.h>
#include <turbojpeg.h>

#include <memory>
#include <opencv2/core.hpp>

namespace parkade {
namespace {

struct Destroy {
  void operator()(void* decoder) const { tjDestroy(decoder); }
};
using Decoder = std::unique_ptr<void, Destroy>;

// One that fails amid a header goes on from there with the next picture: it is made anew.
Error failed(Decoder& decoder) {
  Error error{tjGetErrorStr2(decoder.get())};
  decoder.reset();
  return error;
}

}  // namespace

Status checkImageSize(std::int64_t width, std::int64_t height) {
  if (height <= 0 || width <= kMostImagePixels / height) return {};
  return Error{fmt::format("its header tells {} x {} pixels, more than {}", width, height,
                           kMostImagePixels)};
}

Result<std::optional<cv::Mat>> decodeJpeg(std::string_view bytes, bool gray) {
  // One for each thread: they keep tables and buffers.
  thread_local Decoder kept;
  if (kept == nullptr) kept.reset(tjInitDecompress());
  tjhandle decoder = kept.get();
  if (decoder == nullptr) return Error{tjGetErrorStr2(nullptr)};
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());  // NOLINT
  int width = 0;
  int height = 0;
  int subsampling = 0;
  int colours = 0;
  if (tjDecompressHeader3(decoder, data, bytes.size(), &width, &height, &subsampling, &colours) !=
      0) {
    return failed(kept);
  }
  if (const Status fits = checkImageSize(width, height); !fits) return fits.error();
  if (colours == TJCS_CMYK || colours == TJCS_YCCK) return std::optional<cv::Mat>();
  cv::Mat image(height, width, gray ? CV_8UC1 : CV_8UC3);
  const int code =
      tjDecompress2(decoder, data, bytes.size(), image.data, width, static_cast<int>(image.step),
                    height, gray ? TJPF_GRAY : TJPF_BGR, TJFLAG_ACCURATEDCT);
  // After a warning the picture is whole.
  if (code != 0 && tjGetErrorCode(decoder) != TJERR_WARNING) return failed(kept);
  return std::optional<cv::Mat>(std::move(image));
}

}  // namespace parkade
