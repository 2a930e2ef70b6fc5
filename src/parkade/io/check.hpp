// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace parkade {

/// kWarn: readable, but look at it. kFail: a run would refuse the sequence.
enum class CheckMark { kPass, kWarn, kFail };

/// What was looked at in a sequence or a rig, and how it is.
struct Check {
  CheckMark mark = CheckMark::kPass;
  std::string name;
  std::string detail;
};

const char* toString(CheckMark mark);

/// A line for each, and how many passed, for a reader at a terminal.
std::string checksText(const std::vector<Check>& checks);

bool anyFailed(const std::vector<Check>& checks);

}  // namespace parkade
