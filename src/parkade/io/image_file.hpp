// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "parkade/core/result.hpp"

namespace parkade {

/// How pictures are compressed.
struct ImageEncoding {
  bool png = false;       ///< lossless; otherwise JPEG
  int jpeg_quality = 92;  ///< 1 to 100
  int png_level = 3;      ///< zlib level, 0 to 9
  [[nodiscard]] const char* extension() const { return png ? "png" : "jpg"; }
};

/// Nothing where the bytes are a whole PNG or JPEG file from signature to end mark; otherwise what
/// is wrong. Decoders show a JPEG that was cut off half grey without a word: this is how to know.
Status checkImageBytes(std::string_view bytes);

/// The picture as CV_8UC1 (gray) or CV_8UC3 (BGR). Fails, naming the file, where it is missing, cut
/// off, cannot be decoded or tells more than 2^27 pixels. An EXIF orientation is not applied: the
/// calibration holds for the sensor's rows and columns.
Result<cv::Mat> readImage(const std::string& path, bool gray);

/// CV_8UC1 of a CV_8UC1 or CV_8UC3 (BGR) picture; shares memory with one that is gray.
cv::Mat grayOf(const cv::Mat& image);

/// A picture, and the same in gray where it is wanted beside colour.
struct ImageAndGray {
  cv::Mat image;
  cv::Mat gray;
};

/// A picture in BGR and in gray, each as readImage() gives it. A JPEG holds its gray as it is, and
/// colour turned gray again differs from that by rounding.
Result<ImageAndGray> readImageAndGray(const std::string& path);

/// The file's bytes; the same picture and encoding give the same bytes. image: CV_8UC1 or CV_8UC3.
Result<std::string> encodeImage(const cv::Mat& image, const ImageEncoding& encoding);

/// Encodes and writes a picture, whole or not at all.
Status writeImage(const std::string& path, const cv::Mat& image, const ImageEncoding& encoding);

}  // namespace parkade
