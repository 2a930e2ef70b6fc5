// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "parkade/eval/map_evaluation.hpp"

namespace parkade {

/// The figures as JSON text (docs/evaluation.md, "Maps"), ending in a newline.
std::string mapEvaluationJson(const MapEvaluation& evaluation);

/// The figures as a table for people.
std::string mapEvaluationTable(const MapEvaluation& evaluation);

}  // namespace parkade
