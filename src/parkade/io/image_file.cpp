// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/image_file.hpp"

#include <fmt/core.h>

#include <cstdint>
#include <new>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <type_traits>
#include <utility>

#include "parkade/io/file.hpp"
#include "parkade/io/jpeg.hpp"

namespace parkade {
namespace {

using namespace std::string_view_literals;
constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n"sv;
constexpr std::string_view kJpegSignature = "\xFF\xD8\xFF"sv;

// PNG: chunks of length, type, data, checksum (ISO/IEC 15948, 5.3) up to IEND.
Status checkPng(std::string_view bytes) {
  constexpr std::size_t kChunkOverhead = 12;
  std::size_t position = kPngSignature.size();
  while (position + kChunkOverhead <= bytes.size()) {
    std::uint32_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      length = length << 8 | static_cast<std::uint8_t>(bytes[position + i]);
    }
    if (bytes.substr(position + 4, 4) == "IEND") return {};
    position += kChunkOverhead + length;
  }
  return Error{fmt::format("the PNG file is cut off after {} bytes", bytes.size())};
}

// JPEG: segments of marker, length, data (ITU-T T.81, B.1.1) up to the end mark EOI. After SOS
// comes coded data, in which 0xFF is followed by 0 or a restart mark; whatever else follows is the
// next marker. A thumbnail with an end mark of its own lies inside a segment and is stepped over.
Status checkJpeg(std::string_view bytes) {
  const auto byte_at = [&bytes](std::size_t i) { return static_cast<std::uint8_t>(bytes[i]); };
  constexpr std::uint8_t kEndOfImage = 0xD9;
  constexpr std::uint8_t kStartOfScan = 0xDA;
  std::size_t position = 2;  // behind the start mark
  bool coded = false;
  while (true) {
    position = bytes.find('\xFF', position);
    if (position == std::string_view::npos || position + 1 >= bytes.size()) break;
    const std::uint8_t marker = byte_at(position + 1);
    if (marker == kEndOfImage) return {};
    const bool restart = marker >= 0xD0 && marker <= 0xD7;
    if (marker == 0xFF) {  // a fill byte
      position += 1;
    } else if (restart || (coded && marker == 0)) {
      position += 2;
    } else {
      if (position + 3 >= bytes.size()) break;
      const std::size_t length = byte_at(position + 2) << 8 | byte_at(position + 3);
      coded = marker == kStartOfScan;
      position += 2 + length;
    }
  }
  return Error{fmt::format("the JPEG file is cut off after {} bytes", bytes.size())};
}

Error at(const std::string& path, const std::string& message) {
  return {fmt::format("{}: {}", path, message)};
}

bool isPng(std::string_view bytes) {
  return bytes.substr(0, kPngSignature.size()) == kPngSignature;
}

// The bytes of a whole picture.
Result<std::string> readImageBytes(const std::string& path) {
  Result<std::string> bytes = readFile(path);
  if (!bytes) return bytes;
  if (const Status status = checkImageBytes(*bytes); !status) {
    return at(path, status.error().message);
  }
  return bytes;
}

// IHDR comes first in a PNG, with width and height in front (11.2.2).
Status checkPngSize(std::string_view bytes) {
  constexpr std::size_t kWidth = 16;
  if (bytes.size() < kWidth + 8 || bytes.substr(12, 4) != "IHDR") return {};
  std::int64_t size[2] = {0, 0};
  for (std::size_t i = 0; i < 8; ++i) {
    size[i / 4] = size[i / 4] << 8 | static_cast<std::uint8_t>(bytes[kWidth + i]);
  }
  return checkImageSize(size[0], size[1]);
}

// A PNG in colour is turned gray here: decoding it twice for both would take as long again.
Result<cv::Mat> decodeBytes(const std::string& bytes, bool gray) {
  const bool png = isPng(bytes);
  if (png) {
    if (const Status fits = checkPngSize(bytes); !fits) return fits.error();
  } else {
    Result<std::optional<cv::Mat>> image = decodeJpeg(bytes, gray);
    if (!image) return image.error();
    if (*image) return std::move(**image);
  }
  const int channels = gray ? (png ? cv::IMREAD_ANYCOLOR : cv::IMREAD_GRAYSCALE) : cv::IMREAD_COLOR;
  // A header over the bytes; imdecode only reads them.
  const cv::Mat raw(1, static_cast<int>(bytes.size()), CV_8UC1,
                    const_cast<char*>(bytes.data()));  // NOLINT
  const cv::Mat image = cv::imdecode(raw, channels | cv::IMREAD_IGNORE_ORIENTATION);
  if (image.empty()) return Error{"the file is corrupt"};
  return gray ? grayOf(image) : image;
}

// What a decoder throws, as where memory does not suffice, is an error as well.
template <class Decode>
std::invoke_result_t<Decode> guarded(const std::string& path, const Decode& decode) {
  std::string reason;
  try {
    std::invoke_result_t<Decode> result = decode();
    if (result) return result;
    reason = result.error().message;
  } catch (const cv::Exception& error) {
    reason = error.err;
  } catch (const std::bad_alloc&) {
    reason = "memory does not suffice";
  }
  return at(path, fmt::format("the picture cannot be decoded: {}", reason));
}

}  // namespace

cv::Mat grayOf(const cv::Mat& image) {
  if (image.channels() == 1) return image;
  cv::Mat gray;
  cv::cvtColor(image, gray, cv::COLOR_BGR2GRAY);
  return gray;
}

Status checkImageBytes(std::string_view bytes) {
  if (bytes.empty()) return Error{"the file is empty"};
  if (isPng(bytes)) return checkPng(bytes);
  if (bytes.substr(0, kJpegSignature.size()) == kJpegSignature) return checkJpeg(bytes);
  return Error{"neither a PNG nor a JPEG file"};
}

Result<cv::Mat> readImage(const std::string& path, bool gray) {
  const Result<std::string> bytes = readImageBytes(path);
  if (!bytes) return bytes.error();
  return guarded(path, [&] { return decodeBytes(*bytes, gray); });
}

Result<ImageAndGray> readImageAndGray(const std::string& path) {
  const Result<std::string> bytes = readImageBytes(path);
  if (!bytes) return bytes.error();
  return guarded(path, [&]() -> Result<ImageAndGray> {
    Result<cv::Mat> image = decodeBytes(*bytes, false);
    if (!image) return image.error();
    Result<cv::Mat> gray = isPng(*bytes) ? grayOf(*image) : decodeBytes(*bytes, true);
    if (!gray) return gray.error();
    return ImageAndGray{std::move(*image), std::move(*gray)};
  });
}

Result<std::string> encodeImage(const cv::Mat& image, const ImageEncoding& encoding) {
  PARKADE_CHECK(image.type() == CV_8UC1 || image.type() == CV_8UC3,
                "expected an image of type CV_8UC1 or CV_8UC3, found {}", image.type());
  const std::vector<int> parameters =
      encoding.png ? std::vector<int>{cv::IMWRITE_PNG_COMPRESSION, encoding.png_level}
                   : std::vector<int>{cv::IMWRITE_JPEG_QUALITY, encoding.jpeg_quality};
  std::vector<std::uint8_t> bytes;
  try {
    if (!cv::imencode(encoding.png ? ".png" : ".jpg", image, bytes, parameters)) {
      return Error{fmt::format("cannot encode a {} x {} picture", image.cols, image.rows)};
    }
  } catch (const cv::Exception& error) {
    return Error{
        fmt::format("cannot encode a {} x {} picture: {}", image.cols, image.rows, error.err)};
  }
  return std::string(bytes.begin(), bytes.end());
}

Status writeImage(const std::string& path, const cv::Mat& image, const ImageEncoding& encoding) {
  const Result<std::string> bytes = encodeImage(image, encoding);
  if (!bytes) return at(path, bytes.error().message);
  return writeFileAtomic(path, *bytes);
}

}  // namespace parkade
