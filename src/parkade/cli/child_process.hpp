// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "parkade/core/result.hpp"

namespace parkade::cli {

/// The program that runs now.
std::string programPath();

/// Runs this program with other arguments, as a process of its own, and waits for its end. What it
/// prints goes to the log file. Fails where it cannot be started, ends with another code than 0 or
/// by a signal; the message is then the last line that it printed as "parkade: MESSAGE".
Status runProgram(const std::vector<std::string>& arguments, const std::string& log);

}  // namespace parkade::cli
