// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/learned_rig.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "parkade/cli/camera_errors.hpp"
#include "parkade/core/units.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/sequence_test_support.hpp"
#include "parkade/io/test_support.hpp"

namespace parkade::cli {
namespace {

// One camera found 3 mm further ahead and turned by 0.2 degrees, the others where they were told.
std::vector<CameraCalibrationEstimate> foundCameras(const Rig& told) {
  std::vector<CameraCalibrationEstimate> found(told.cameras.size());
  for (std::size_t c = 0; c < found.size(); ++c) {
    found[c].T_vehicle_cam = told.cameras[c].T_vehicle_cam;
    found[c].sigma << 1e-3, 1e-3, 1e-3, 1e-4, 1e-4, 1e-4, 1e-3, 0.0;
  }
  const SE3& before = told.cameras[0].T_vehicle_cam;
  found[0].T_vehicle_cam = SE3(SO3::exp({0.0, 0.0, 0.2 * kDegree}) * before.rotation(),
                               before.translation() + Eigen::Vector3d(0.003, 0.0, 0.0));
  found[0].time_offset = 0.002;
  found[1].time_offset = 4e-9;
  return found;
}

TEST(LearnedRig, PlacesAndClocksAreThoseFoundAndMasksHaveFullPaths) {
  Rig told = test::smallRig();
  told.cameras[0].time_offset_ns = 5 * kNsPerMs;
  told.cameras[0].mask_path = "masks/../front.png";
  const Rig rig = learnedRig(told, foundCameras(told));
  EXPECT_NEAR(rig.cameras[0].T_vehicle_cam.translation().x() -
                  told.cameras[0].T_vehicle_cam.translation().x(),
              0.003, 1e-12);
  EXPECT_NEAR(rig.cameras[0].position_sigma, 1e-3, 1e-12);
  EXPECT_NEAR(rig.cameras[0].rotation_sigma, 1e-4, 1e-12);
  EXPECT_EQ(rig.cameras[0].time_offset_ns, 7 * kNsPerMs);
  EXPECT_EQ(rig.cameras[1].time_offset_ns, told.cameras[1].time_offset_ns);
  EXPECT_EQ(rig.cameras[0].mask_path, std::filesystem::current_path() / "front.png");
  for (std::size_t c = 1; c < rig.cameras.size(); ++c) EXPECT_EQ(rig.cameras[c].mask_path, "");
}

TEST(LearnedRig, ReadoutTimesAreThoseFoundWhereTheyAreRefined) {
  Rig told = test::smallRig();
  for (RigCamera& camera : told.cameras) camera.readout_time = 0.1 / 3.0;
  auto found = foundCameras(told);
  for (auto& camera : found) camera.readout_time = 0.0300004;
  found[0].sigma(7) = 1e-5;
  const Rig rig = learnedRig(told, found);
  EXPECT_EQ(rig.cameras[0].readout_time, 0.03);
  EXPECT_EQ(rig.cameras[1].readout_time, told.cameras[1].readout_time);
  EXPECT_EQ(calibrationJson(told.cameras[0], found[0])["readout_time_s"], 0.0300004);
  EXPECT_FALSE(calibrationJson(test::smallRig().cameras[0], found[0]).contains("readout_time_s"));
}

TEST(LearnedRig, CalibrationTellsMovesAlongAndAboutTheVehiclesAxes) {
  const Rig told = test::smallRig();
  const nlohmann::json json = calibrationJson(told.cameras[0], foundCameras(told)[0]);
  EXPECT_EQ(json["camera"], told.cameras[0].name);
  EXPECT_NEAR(json["moved_m"][0].get<double>(), 0.003, 1e-12);
  EXPECT_NEAR(json["turned_rad"][2].get<double>(), 0.2 * kDegree, 1e-9);
}

class LearnedRigFiles : public testing::Test {
 protected:
  void writeRun(const nlohmann::json& calibration) {
    const nlohmann::json metrics{{"calibration", calibration}};
    ASSERT_TRUE(writeFileAtomic(joinPath(folder_.path(), "metrics.json"), metrics.dump()).ok());
  }
  void writeTruth(const Rig& rig) {
    ASSERT_TRUE(makeFolders(joinPath(folder_.path(), "truth")).ok());
    ASSERT_TRUE(writeRig(rig, joinPath(folder_.path(), "truth/rig.yaml")).ok());
  }

  test::TemporaryFolder folder_;
};

TEST_F(LearnedRigFiles, ErrorsAreOfWhatWasToldAndOfWhatWasFound) {
  const Rig told = test::smallRig();
  const auto found = foundCameras(told);
  nlohmann::json calibration;
  for (std::size_t c = 0; c < found.size(); ++c) {
    calibration.push_back(calibrationJson(told.cameras[c], found[c]));
  }
  writeRun(calibration);
  writeTruth(learnedRig(told, found));
  Evaluation evaluation;
  const Status judged = judgeCameras(folder_.path(), folder_.path(), evaluation);
  ASSERT_TRUE(judged.ok()) << judged.error().message;
  ASSERT_TRUE(evaluation.cameras.has_value());
  const double axes = 3.0 * static_cast<double>(found.size());
  EXPECT_EQ(evaluation.cameras->cameras, static_cast<int>(found.size()));
  EXPECT_NEAR(evaluation.cameras->told_m, 0.003 / std::sqrt(axes), 1e-9);
  EXPECT_NEAR(evaluation.cameras->told_deg, 0.2 / std::sqrt(axes), 1e-6);
  EXPECT_NEAR(evaluation.cameras->found_m, 0.0, 1e-9);
  EXPECT_NEAR(evaluation.cameras->found_deg, 0.0, 1e-6);
  EXPECT_NEAR(evaluation.cameras->nees_turn, 0.0, 1e-6);

  // Against what was told as the truth, the errors are those of what was found.
  writeTruth(told);
  ASSERT_TRUE(judgeCameras(folder_.path(), folder_.path(), evaluation).ok());
  const double cameras = static_cast<double>(found.size());
  EXPECT_NEAR(evaluation.cameras->told_m, 0.0, 1e-9);
  EXPECT_NEAR(evaluation.cameras->found_m, 0.003 / std::sqrt(axes), 1e-9);
  EXPECT_NEAR(evaluation.cameras->nees_place, 9.0 / cameras, 1e-6);
  EXPECT_NEAR(evaluation.cameras->nees_turn, std::pow(0.2 * kDegree / 1e-4, 2) / cameras, 1e-3);
}

TEST_F(LearnedRigFiles, ErrorsNameTheFile) {
  writeTruth(test::smallRig());
  writeRun({{{"camera", "nobody"}, {"told_T_vehicle_cam", 1}}});
  Evaluation evaluation;
  Status judged = judgeCameras(folder_.path(), folder_.path(), evaluation);
  ASSERT_FALSE(judged.ok());
  EXPECT_THAT(judged.error().message,
              testing::HasSubstr("metrics.json: the run's camera 'nobody'"));
  ASSERT_TRUE(writeFileAtomic(joinPath(folder_.path(), "metrics.json"), "{").ok());
  judged = judgeCameras(folder_.path(), folder_.path(), evaluation);
  ASSERT_FALSE(judged.ok());
  EXPECT_THAT(judged.error().message, testing::HasSubstr("metrics.json: cannot be read"));
  EXPECT_FALSE(evaluation.cameras.has_value());
}

TEST_F(LearnedRigFiles, AFolderStandsForItsRig) {
  const Result<std::string> none = rigFileOf(folder_.path());
  ASSERT_FALSE(none.ok());
  EXPECT_THAT(none.error().message, testing::HasSubstr("holds no rig.yaml"));
  const std::string file = joinPath(folder_.path(), "rig.yaml");
  ASSERT_TRUE(writeRig(test::smallRig(), file).ok());
  EXPECT_EQ(*rigFileOf(folder_.path()), file);
  EXPECT_EQ(*rigFileOf(file), file);
}

}  // namespace
}  // namespace parkade::cli
