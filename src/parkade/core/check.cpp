// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/core/check.hpp"

namespace parkade::internal {

void throwCheckError(const char* file, int line, const char* condition,
                     const std::string& message) {
  throw CheckError(fmt::format("{}:{}: check failed: {}{}{}", file, line, condition,
                               message.empty() ? "" : ": ", message));
}

}  // namespace parkade::internal
