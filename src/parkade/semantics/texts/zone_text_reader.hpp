// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "parkade/core/result.hpp"
#include "parkade/semantics/networks/sequence_likelihood.hpp"
#include "parkade/types/text_reading.hpp"

namespace parkade {

/// What zones are named with: I and O look like digits.
inline constexpr const char* kZoneLetters = "0123456789ABCDEFGHJKLMNPQRSTUVWXYZ-";

/// Reads straightened faces of zone markers with a small sequence network, run by OpenCV. Not
/// thread-safe: it keeps buffers.
class ZoneTextReader {
 public:
  /// Reads a YAML file that names the network, its input and its letters (docs/networks.md,
  /// "Reading zone texts"), and tries the network on an empty patch. Fails with the file and what
  /// is wrong: no such file, no ONNX, an input of another size, another number of letters.
  static Result<ZoneTextReader> load(const std::string& path);

  ZoneTextReader(ZoneTextReader&&) noexcept;
  ZoneTextReader& operator=(ZoneTextReader&&) noexcept;
  ~ZoneTextReader();

  /// The most probable texts of a patch (CV_8UC3, kZonePatchWidth x kZonePatchHeight, checked),
  /// best first; the empty text says that nothing is written there. only: where given, texts of
  /// these letters alone.
  Result<std::vector<TextReading>> read(const cv::Mat& patch, const std::string& only = {});

  /// All that it says of a patch; of these letters alone, where given.
  Result<SequenceLikelihood> look(const cv::Mat& patch, const std::string& only = {});

  /// The same for the patches that a tall one holds (CV_8UC3, kZonePatchWidth x kTallPatchHeight,
  /// checked), from the uppermost down, kTallPatchStep px apart. None where the network does not
  /// take tall patches: it must be convolutional over its rows.
  Result<std::vector<SequenceLikelihood>> lookAround(const cv::Mat& tall,
                                                     const std::string& only = {});

  /// The most probable texts by what it says, best first.
  static std::vector<TextReading> readingsOf(const SequenceLikelihood& letters);

  [[nodiscard]] const std::string& letters() const;

  /// Whether it knows all characters that an option wants to be read; fails with the option.
  [[nodiscard]] Status knows(const std::string& wanted, const std::string& option) const;

 private:
  struct Impl;
  explicit ZoneTextReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace parkade
