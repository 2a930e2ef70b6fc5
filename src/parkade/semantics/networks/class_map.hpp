// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "parkade/core/result.hpp"
#include "parkade/types/semantic_class.hpp"

namespace parkade {

/// What a segmentation network takes and gives, as its YAML file says (docs/networks.md).
struct ClassMap {
  std::string path;     ///< the file itself, for messages
  std::string network;  ///< path of the ONNX file; in the file relative to its folder
  int width = 384;      ///< px, of the input
  int height = 384;
  bool any_size = false;  ///< other sizes are fine as well, in multiples of 32
  bool rgb = true;        ///< order of the input's channels; otherwise BGR
  std::array<double, 3> mean = {0.0, 0.0, 0.0};  ///< subtracted from 0 to 255, in the input's order
  std::array<double, 3> scale = {1.0, 1.0, 1.0};  ///< then multiplied with
  double metres_per_px = 0.0;  ///< of a network for bird's-eye pictures; 0: for camera views
  std::vector<SemanticClass> classes;  ///< of the output's channels; one may come several times
  /// Of a bird's-eye network: its unknown stands for what the picture does not show, and is told
  /// nowhere else.
  bool unknown_is_unseen = false;
  bool mirror = false;  ///< label the mirror image as well and take the mean of both logits
};

/// Fails with file, line and key on a missing file, an unknown key or class, or a bad value.
/// Whether the ONNX file is there is not asked.
Result<ClassMap> readClassMap(const std::string& path);

/// A network that comes with Parkade ("bev_segmentation"): the path of its class map. Looks in the
/// folder that PARKADE_MODELS names, where Parkade was installed, and in its source tree; fails
/// with the places looked at.
Result<std::string> findModel(const std::string& name);

/// The user's file where one is named, else Parkade's own of that name.
Result<std::string> namedOrOwnModel(const std::string& path, const std::string& own_name);

}  // namespace parkade
