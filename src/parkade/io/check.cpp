// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/check.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace parkade {

const char* toString(CheckMark mark) {
  switch (mark) {
    case CheckMark::kPass:
      return "ok";
    case CheckMark::kWarn:
      return "warn";
    case CheckMark::kFail:
      break;
  }
  return "FAIL";
}

std::string checksText(const std::vector<Check>& checks) {
  const auto count = [&checks](CheckMark mark) {
    return std::count_if(checks.begin(), checks.end(),
                         [mark](const Check& check) { return check.mark == mark; });
  };
  std::string text = "checks\n";
  for (const Check& check : checks) {
    text += fmt::format("  {:<5} {:<19} {}\n", toString(check.mark), check.name, check.detail);
  }
  return text + fmt::format("{} checks passed, {} warnings, {} failed\n", count(CheckMark::kPass),
                            count(CheckMark::kWarn), count(CheckMark::kFail));
}

bool anyFailed(const std::vector<Check>& checks) {
  return std::any_of(checks.begin(), checks.end(),
                     [](const Check& check) { return check.mark == CheckMark::kFail; });
}

}  // namespace parkade
