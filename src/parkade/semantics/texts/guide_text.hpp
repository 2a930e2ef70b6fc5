// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace parkade {

/// What guide signs are read with: capitals and the arrow that stands before or behind the word.
inline constexpr const char* kGuideLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ<>^";

/// The meaning of a guide sign (docs/formats.md) that reads so: "<EXIT" is exit_left, "P^" is
/// parking_straight; without an arrow the word itself, "EXIT". Empty where an arrow has no word or
/// is not the only one.
std::string guideMeaning(const std::string& reading);

/// What a sign of this meaning reads: the inverse of guideMeaning().
std::string guideReading(const std::string& meaning);

}  // namespace parkade
