// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/rig_checks.hpp"

#include <gmock/gmock.h>

#include "parkade/io/sequence_test_support.hpp"

namespace parkade {
namespace {

using testing::HasSubstr;

Rig rigWith(const PinholeRadtan::Parameters& parameters) {
  Rig rig = test::smallRig(1);
  rig.cameras[0].camera = Camera(PinholeRadtan(parameters), 64, 48);
  return rig;
}

PinholeRadtan::Parameters pinhole(double focal, double cx, double cy) {
  PinholeRadtan::Parameters p;
  p.fx = p.fy = focal;
  p.cx = cx;
  p.cy = cy;
  return p;
}

TEST(RigChecks, ASaneRigPasses) {
  const std::vector<Check> checks = checkRig(test::smallRig());
  ASSERT_EQ(checks.size(), 2u);
  EXPECT_EQ(checks[1].name, "cam1 intrinsics");
  for (const Check& check : checks) EXPECT_EQ(check.mark, CheckMark::kPass) << check.detail;
  EXPECT_THAT(checksText(checks), HasSubstr("2 checks passed, 0 warnings, 0 failed"));
}

TEST(RigChecks, IntrinsicsOfAnotherSizeAreSuspect) {
  const Check doubled = checkRig(rigWith(pinhole(100.0, 63.5, 47.5))).front();
  EXPECT_EQ(doubled.mark, CheckMark::kWarn);
  EXPECT_THAT(doubled.detail, HasSubstr("at (64, 48) px of 64 x 48"));
  EXPECT_EQ(checkRig(rigWith(pinhole(25.0, 15.5, 11.5))).front().mark, CheckMark::kWarn);
}

TEST(RigChecks, FocalLengthsThatShowNothingOrTooMuchAreSuspect) {
  for (const double focal : {1e-3, 1.0, 1000.0}) {
    const Check check = checkRig(rigWith(pinhole(focal, 31.5, 23.5))).front();
    EXPECT_EQ(check.mark, CheckMark::kWarn) << focal << ": " << check.detail;
  }
}

TEST(RigChecks, RigsOfRealCarsPass) {
  for (const char* name : {"avm4", "avp6", "euroc", "garage_fisheye_real", "garage_fisheye_sim",
                           "nuscenes6", "roecs_fisheye_real"}) {
    const auto rig = readRig(std::string(PARKADE_SOURCE_DIR) + "/config/rigs/" + name + ".yaml");
    ASSERT_TRUE(rig.ok()) << rig.error().message;
    for (const Check& check : checkRig(*rig)) {
      EXPECT_EQ(check.mark, CheckMark::kPass) << name << ", " << check.name << ": " << check.detail;
    }
  }
}

}  // namespace
}  // namespace parkade
