// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "parkade/core/result.hpp"
#include "parkade/sim/garage.hpp"

namespace parkade::sim {

/// The garage as JSON text (docs/formats.md, "Truth of a simulated garage"). Numbers are written so
/// that they read back to the same bits.
std::string garageTruthText(const Garage& garage);

/// Writes garageTruthText to a file, whole or not at all. Fails where the file cannot be written.
Status writeGarageTruth(const Garage& garage, const std::string& path);

/// Reads such a file. Fails, with file and key, on a missing file, bad syntax, a missing key, a
/// value of the wrong type, an unknown class or slot type, and another version of the format.
Result<Garage> readGarageTruth(const std::string& path);

}  // namespace parkade::sim
