// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <string_view>

#include "parkade/core/result.hpp"

namespace parkade {

/// A JPEG as CV_8UC1 (gray) or CV_8UC3 (BGR): to the bit what cv::imdecode gives, which writes RGB
/// and turns it round afterwards, in two thirds of the time. Fails where the bytes cannot be
/// decoded; nothing for a JPEG in CMYK, which the library does not turn into BGR.
Result<std::optional<cv::Mat>> decodeJpeg(std::string_view bytes, bool gray);

}  // namespace parkade
