// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>

namespace parkade::cli {

// Checks of options whose messages say what is expected; CLI11's own for numbers print a range of
// 600 digits.

inline CLI::Validator numberCheck(const std::string& expected, bool (*good)(double)) {
  return {[expected, good](std::string& text) {
            double value = 0.0;
            const bool number = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
            return number && good(value) ? std::string()
                                         : "expected " + expected + ", found '" + text + "'";
          },
          ""};
}

inline CLI::Validator notNegative() {
  return numberCheck("a number of 0 or more", [](double value) { return value >= 0.0; });
}

inline CLI::Validator positive() {
  return numberCheck("a number above 0", [](double value) { return value > 0.0; });
}

/// A file name with the ending of what is written there.
inline CLI::Validator endsWith(const std::string& ending) {
  return {[ending](std::string& text) {
            return text.ends_with(ending)
                       ? std::string()
                       : "expected a file that ends with '" + ending + "', found '" + text + "'";
          },
          ""};
}

}  // namespace parkade::cli
