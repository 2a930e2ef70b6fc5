// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/tracking/grid_sampling.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "parkade/core/check.hpp"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace parkade {
namespace {

// Where the samples of a grid lie before the warp.
struct GridOffsets {
  std::vector<float> x;
  std::vector<float> y;
};

const GridOffsets& offsetsOf(int radius) {
  static const std::array<GridOffsets, kMostGridRadius + 1> kOffsets = [] {
    std::array<GridOffsets, kMostGridRadius + 1> all;
    for (int r = 0; r <= kMostGridRadius; ++r) {
      GridOffsets& offsets = all[static_cast<std::size_t>(r)];
      for (int y = -r; y <= r; ++y) {
        for (int x = -r; x <= r; ++x) {
          offsets.x.push_back(static_cast<float>(x));
          offsets.y.push_back(static_cast<float>(y));
        }
      }
    }
    return all;
  }();
  return kOffsets[static_cast<std::size_t>(radius)];
}

// The grid relative to a pixel that none of its samples lies left of or above: single precision
// keeps some 1e-6 px there.
struct PlacedGrid {
  const std::uint8_t* data = nullptr;  // that pixel
  int stride = 0;
  float u = 0.0F;  // the grid's middle
  float v = 0.0F;
  float ux = 0.0F;  // warp
  float uy = 0.0F;
  float vx = 0.0F;
  float vy = 0.0F;
};

void sampleFrom(const PlacedGrid& g, const GridOffsets& offsets, std::size_t first, float* out) {
  for (std::size_t k = first; k < offsets.x.size(); ++k) {
    const float u = (g.u + offsets.y[k] * g.uy) + offsets.x[k] * g.ux;
    const float v = (g.v + offsets.y[k] * g.vy) + offsets.x[k] * g.vx;
    const int iu = static_cast<int>(u);
    const int iv = static_cast<int>(v);
    const float fu = u - static_cast<float>(iu);
    const float fv = v - static_cast<float>(iv);
    const std::uint8_t* p = g.data + iv * g.stride + iu;
    const auto p00 = static_cast<float>(p[0]);
    const auto p01 = static_cast<float>(p[1]);
    const auto p10 = static_cast<float>(p[g.stride]);
    const auto p11 = static_cast<float>(p[g.stride + 1]);
    const float top = p00 + fu * (p01 - p00);
    const float bottom = p10 + fu * (p11 - p10);
    out[k] = top + fv * (bottom - top);
  }
}

#if defined(__x86_64__)
constexpr std::size_t kLanes = 8;

// One gather takes a pixel and its right neighbour (and two bytes more).
__attribute__((target("avx2"))) inline __m256 blend(__m256i pixels, __m256 fraction) {
  const __m256i byte = _mm256_set1_epi32(0xFF);
  const __m256 left = _mm256_cvtepi32_ps(_mm256_and_si256(pixels, byte));
  const __m256 right = _mm256_cvtepi32_ps(_mm256_and_si256(_mm256_srli_epi32(pixels, 8), byte));
  return _mm256_add_ps(left, _mm256_mul_ps(fraction, _mm256_sub_ps(right, left)));
}

// All samples in full eights; how many these are.
__attribute__((target("avx2"))) std::size_t sampleEights(const PlacedGrid& g,
                                                         const GridOffsets& offsets, float* out) {
  const __m256 u0 = _mm256_set1_ps(g.u);
  const __m256 v0 = _mm256_set1_ps(g.v);
  const __m256i stride = _mm256_set1_epi32(g.stride);
  std::size_t k = 0;
  for (; k + kLanes <= offsets.x.size(); k += kLanes) {
    const __m256 x = _mm256_loadu_ps(offsets.x.data() + k);
    const __m256 y = _mm256_loadu_ps(offsets.y.data() + k);
    const __m256 u = _mm256_add_ps(_mm256_add_ps(u0, _mm256_mul_ps(y, _mm256_set1_ps(g.uy))),
                                   _mm256_mul_ps(x, _mm256_set1_ps(g.ux)));
    const __m256 v = _mm256_add_ps(_mm256_add_ps(v0, _mm256_mul_ps(y, _mm256_set1_ps(g.vy))),
                                   _mm256_mul_ps(x, _mm256_set1_ps(g.vx)));
    const __m256i iu = _mm256_cvttps_epi32(u);
    const __m256i iv = _mm256_cvttps_epi32(v);
    const __m256 fu = _mm256_sub_ps(u, _mm256_cvtepi32_ps(iu));
    const __m256 fv = _mm256_sub_ps(v, _mm256_cvtepi32_ps(iv));
    const __m256i at = _mm256_add_epi32(_mm256_mullo_epi32(iv, stride), iu);
    const auto* rows = reinterpret_cast<const int*>(g.data);
    const auto* next = reinterpret_cast<const int*>(g.data + g.stride);
    const __m256 top = blend(_mm256_i32gather_epi32(rows, at, 1), fu);
    const __m256 bottom = blend(_mm256_i32gather_epi32(next, at, 1), fu);
    _mm256_storeu_ps(out + k, _mm256_add_ps(top, _mm256_mul_ps(fv, _mm256_sub_ps(bottom, top))));
  }
  return k;
}

bool hasEights() {
  static const bool kHas = __builtin_cpu_supports("avx2") != 0;
  return kHas;
}
#else
std::size_t sampleEights(const PlacedGrid&, const GridOffsets&, float*) {
  return 0;
}
bool hasEights() {
  return false;
}
#endif

}  // namespace

bool sampleGrid(const cv::Mat& image, const Eigen::Vector2d& pixel, const Eigen::Matrix2d& warp,
                int radius, float* out) {
  PARKADE_CHECK(radius >= 0 && radius <= kMostGridRadius, "a grid of radius {}", radius);
  const double reach_x = radius * (std::abs(warp(0, 0)) + std::abs(warp(0, 1)));
  const double reach_y = radius * (std::abs(warp(1, 0)) + std::abs(warp(1, 1)));
  if (!(pixel.x() - reach_x >= 0.0 && pixel.y() - reach_y >= 0.0 &&
        pixel.x() + reach_x < image.cols - 1.001 && pixel.y() + reach_y < image.rows - 1.001)) {
    return false;  // NaN ends here as well
  }
  const int left = static_cast<int>(pixel.x() - reach_x);
  const int above = static_cast<int>(pixel.y() - reach_y);
  PlacedGrid grid;
  grid.stride = static_cast<int>(image.step[0]);
  grid.data = image.data + above * grid.stride + left;
  grid.u = static_cast<float>(pixel.x() - left);
  grid.v = static_cast<float>(pixel.y() - above);
  grid.ux = static_cast<float>(warp(0, 0));
  grid.uy = static_cast<float>(warp(0, 1));
  grid.vx = static_cast<float>(warp(1, 0));
  grid.vy = static_cast<float>(warp(1, 1));
  const GridOffsets& offsets = offsetsOf(radius);
  constexpr double kReadsOn = 4.001;  // px: a gather must not leave the picture's memory
  const bool is_inside = pixel.x() + reach_x < image.cols - kReadsOn;
  const std::size_t done = hasEights() && is_inside ? sampleEights(grid, offsets, out) : 0;
  sampleFrom(grid, offsets, done, out);
  return true;
}

}  // namespace parkade
