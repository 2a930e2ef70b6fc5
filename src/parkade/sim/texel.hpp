// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <bit>
#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace parkade::sim {

// Reading textures: texels of four values, cells, mip levels. These run several times per ray.

inline constexpr float kTexelScale = 127.0F;  ///< of stored values: 1.0 is stored as 127

/// Rounds down. Without SSE 4.1, std::floor is a call; this is two instructions. For |x| < 2^31.
inline int floorToInt(float x) {
  const int truncated = static_cast<int>(x);
  return truncated - (x < static_cast<float>(truncated) ? 1 : 0);
}

/// Base-2 logarithm of a positive number, straight between powers of two (within 0.09).
inline float fastLog2(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  return static_cast<float>(bits) * (1.0F / 8388608.0F) - 127.0F;
}

/// The first mip level whose texels, 2^level wide, reach 0.7 of a footprint in texels of level 0.
inline int mipLevelFor(float footprint) {
  const float ratio = footprint * (1.0F / 1.4142F);
  return ratio <= 1.0F ? 0
                       : static_cast<int>((std::bit_cast<std::uint32_t>(ratio) - 1U) >> 23U) - 126;
}

#if defined(__SSE2__)
inline Eigen::Vector4f vectorOf(__m128 values) {
  Eigen::Vector4f out;
  _mm_store_ps(out.data(), values);
  return out;
}
#endif

/// Four neighbouring values as floats.
inline Eigen::Vector4f texelOf(const std::uint16_t* values) {
#if defined(__SSE2__)
  const __m128i raw = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(values));
  return vectorOf(_mm_cvtepi32_ps(_mm_unpacklo_epi16(raw, _mm_setzero_si128())));
#else
  return {static_cast<float>(values[0]), static_cast<float>(values[1]),
          static_cast<float>(values[2]), static_cast<float>(values[3])};
#endif
}
/// Four values of 8 bits with sign, the first lowest, as floats.
inline Eigen::Vector4f texelOf(std::uint32_t packed) {
#if defined(__SSE2__)
  const __m128i raw = _mm_cvtsi32_si128(static_cast<int>(packed));
  const __m128i words = _mm_unpacklo_epi8(raw, raw);
  return vectorOf(_mm_cvtepi32_ps(_mm_srai_epi32(_mm_unpacklo_epi16(words, words), 24)));
#else
  const auto value = [&](unsigned shift) {
    return static_cast<float>(static_cast<std::int8_t>(packed >> shift & 0xffU));
  };
  return {value(0), value(8), value(16), value(24)};
#endif
}

}  // namespace parkade::sim
