// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>

#include "parkade/camera/rig.hpp"
#include "parkade/io/test_support.hpp"
#include "parkade/sim/drive/rig_presets.hpp"

// What `parkade sim` writes, told by the program itself.

namespace parkade::cli {
namespace {

using testing::HasSubstr;
using testing::Not;

// A second in a small garage; whether it was recorded.
bool recordSecond(const std::string& out, const std::string& options) {
  const std::string command = std::string(PARKADE_PROGRAM) +
                              " sim --garage random --garage-seed 5011 --seed 5011 --fast"
                              " --duration 1 --out '" +
                              out + "' " + options + " 2>/dev/null";
  return std::system(command.c_str()) == 0;
}

std::set<std::string> stemsIn(const std::string& folder) {
  std::set<std::string> stems;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    stems.insert(entry.path().stem().string());
  }
  return stems;
}

TEST(SimRecord, LabelsAreNamedLikeThePicturesOfCamerasWithTimeOffsets) {
  const test::TemporaryFolder folder;
  Rig rig = sim::loadRig("avp6").value().subset({"cam0", "cam1"}).value();
  for (RigCamera& camera : rig.cameras) camera.camera = camera.camera.scaled(0.25);
  rig.cameras[1].time_offset_ns = 2 * kNsPerMs;
  ASSERT_TRUE(writeRig(rig, folder.path("small.yaml")).ok());
  const std::string out = folder.path("out");
  ASSERT_TRUE(recordSecond(out, "--labels --rig '" + folder.path("small.yaml") + "'"));
  for (const char* camera : {"cam0", "cam1"}) {
    const std::set<std::string> labels = stemsIn(out + "/truth/labels/" + camera);
    EXPECT_EQ(labels.size(), 10U);
    EXPECT_EQ(labels, stemsIn(out + "/mav0/" + camera + "/data")) << camera;
  }
  EXPECT_NE(stemsIn(out + "/truth/labels/cam0"), stemsIn(out + "/truth/labels/cam1"));
}

TEST(SimRecord, ParkedSeedIsInTheSpecWhereItIsNotTheGarages) {
  const test::TemporaryFolder folder;
  const auto spec_of = [&](const std::string& name, const std::string& options) {
    EXPECT_TRUE(recordSecond(folder.path(name), "--no-images " + options));
    return test::bytesOf(folder.path(name + "/spec.yaml"));
  };
  const std::string usual = spec_of("usual", "");
  EXPECT_THAT(usual, Not(HasSubstr("parked_seed")));
  EXPECT_EQ(spec_of("same", "--parked-seed 5011"), usual);
  EXPECT_THAT(spec_of("later", "--parked-seed 5012"), HasSubstr("parked_seed: 5012"));
}

}  // namespace
}  // namespace parkade::cli
