// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "parkade/core/result.hpp"
#include "parkade/sim/drive/simulation.hpp"

namespace parkade::cli {

struct RecordOptions {
  std::string out;          ///< the sequence's folder
  bool labels = false;      ///< a label image for every picture
  bool bev_labels = false;  ///< labels of the ground around the car for every frame set
  bool gray_png = false;    ///< gray PNG instead of colour JPEG
  bool resume = false;      ///< draw what is missing of an interrupted recording
  bool force = false;       ///< replace a recording
};

/// Records a drive as a sequence folder with its truth, and shows progress. Fails where the folder
/// holds something already (unless asked to go on or to replace a recording), where the recording
/// to go on with was made with other options, and where the disk does not take the files.
Status recordSequence(std::shared_ptr<const sim::Simulation> simulation,
                      const RecordOptions& options);

/// Processors of this machine.
int defaultThreads();

}  // namespace parkade::cli
