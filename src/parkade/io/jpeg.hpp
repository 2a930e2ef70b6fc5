// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string_view>

#include "parkade/core/result.hpp"

namespace parkade {

/// Pictures with more pixels are refused before memory is taken for them: a corrupt header may tell
/// any size.
inline constexpr std::int64_t kMostImagePixels = 1LL << 27;
Status checkImageSize(std::int64_t width, std::int64_t height);

/// A JPEG as CV_8UC1 (gray) or CV_8UC3 (BGR): to the bit what cv::imdecode gives, which writes RGB
/// and turns it round afterwards, in two thirds of the time. Fails where the bytes cannot be
/// decoded or tell more than kMostImagePixels; nothing for a JPEG in CMYK, which the library does
/// not turn into BGR. Throws cv::Exception where memory does not suffice.
Result<std::optional<cv::Mat>> decodeJpeg(std::string_view bytes, bool gray);

}  // namespace parkade
