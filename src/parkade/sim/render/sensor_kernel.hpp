// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace parkade::sim {

/// What one row of the sensor needs; plain arrays, so that the loop compiles for several
/// instruction sets without anything shared leaking out of it.
struct SensorRow {
  const float* radiance = nullptr;            ///< 3 per pixel: red, green, blue
  const float* electrons_per_nit = nullptr;   ///< 3 per pixel
  const float* level_per_electron = nullptr;  ///< 3 per pixel; the ADC's full scale is 4095
  const float* quantiles = nullptr;           ///< 4096 of the standard normal distribution
  const std::uint8_t* response = nullptr;     ///< 4096: level to byte
  float read_variance = 0.0F;
  float noise = 1.0F;  ///< 0 switches it off
  std::uint32_t key = 0;
  std::uint32_t first = 0;      ///< counter of the row's first value
  int values = 0;               ///< 3 times the width
  std::uint8_t* out = nullptr;  ///< red, green, blue
};

void exposeRow(const SensorRow& row);

}  // namespace parkade::sim
