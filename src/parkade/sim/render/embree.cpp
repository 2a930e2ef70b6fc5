// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/embree.hpp"

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include "parkade/core/check.hpp"
#include "parkade/core/log.hpp"

namespace parkade::sim {

EmbreeDevice makeEmbreeDevice() {
  EmbreeDevice device(rtcNewDevice("threads=1"));
  PARKADE_CHECK(device != nullptr, "Embree cannot start: error {}",
                static_cast<int>(rtcGetDeviceError(nullptr)));
  rtcSetDeviceErrorFunction(
      device.get(),
      [](void*, RTCError code, const char* text) {
        logError("Embree error {}: {}", static_cast<int>(code), text);
      },
      nullptr);
  return device;
}

#if defined(__SSE2__)
namespace {
constexpr unsigned kFlushToZero = 0x8000U;
constexpr unsigned kDenormalsAreZero = 0x0040U;
}  // namespace

FlushDenormals::FlushDenormals() : saved_(_mm_getcsr()) {
  _mm_setcsr(saved_ | kFlushToZero | kDenormalsAreZero);
}
FlushDenormals::~FlushDenormals() {
  _mm_setcsr(saved_);
}
#else
FlushDenormals::FlushDenormals() : saved_(0) {}
FlushDenormals::~FlushDenormals() = default;
#endif

}  // namespace parkade::sim
