// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/tracer.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <string>

namespace parkade::sim {
namespace {

// Embree traces sixteen lanes at once, twice eight, or four times four, by what the processor can;
// it takes the widest up to the one that is asked for.
class EveryInstructionSet : public testing::TestWithParam<std::string> {};

// A square of 2 m, 1 m above the origin.
RenderMesh square() {
  RenderMesh mesh;
  mesh.positions = {{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}};
  mesh.triangles = {{.v = {0, 1, 2}}, {.v = {0, 2, 3}}};
  return mesh;
}

TEST_P(EveryInstructionSet, LanesThatAreOffAreNotTraced) {
  const EmbreeDevice device(rtcNewDevice(GetParam().c_str()));
  StaticGeometry geometry;
  geometry.mesh = square();
  geometry.groups.push_back({kMaskSolid, 0, 2});
  const StaticTracer tracer(device.get(), std::move(geometry));
  for (const int on : {0, 5, 12, 15}) {
    RayPacket rays;
    std::memset(&rays, 0xff, sizeof(rays));  // what happens to lie there: not even numbers
    rays.clear(kMaskAll);
    rays.set(on, {0.2F, 0.1F, 0.0F}, Eigen::Vector3f::UnitZ(), 5.0F);
    tracer.occlude(rays);
    for (int k = 0; k < kPacket; ++k) EXPECT_EQ(rays.valid[k] != 0, k == on);
    EXPECT_LT(rays.rays.ray.tfar[on], 0.0F) << "the square is in the way";

    std::memset(&rays, 0xff, sizeof(rays));
    rays.clear(kMaskAll);
    rays.set(on, {0.2F, 0.1F, 0.0F}, Eigen::Vector3f::UnitZ(), kFar);
    tracer.intersect(rays, false);
    for (int k = 0; k < kPacket; ++k) {
      EXPECT_EQ(tracer.triangleOf(rays, k) == kNoTriangle, k != on) << "lane " << k;
    }
    EXPECT_NEAR(rays.rays.ray.tfar[on], 1.0F, 1e-6F);
  }
}

INSTANTIATE_TEST_SUITE_P(Embree, EveryInstructionSet,
                         testing::Values("threads=1", "threads=1,isa=avx2", "threads=1,isa=avx",
                                         "threads=1,isa=sse4.2", "threads=1,isa=sse2"));

}  // namespace
}  // namespace parkade::sim
