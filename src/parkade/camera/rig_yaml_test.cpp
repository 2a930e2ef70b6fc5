// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "parkade/camera/rig.hpp"
#include "parkade/camera/test_folder.hpp"
#include "parkade/core/random.hpp"
#include "parkade/core/units.hpp"

namespace parkade {
namespace {

using testing::HasSubstr;

// Line numbers matter below: they are part of the messages.
const char* const kRig = R"(name: two cameras
vehicle:
  wheelbase: 2.7
  track: 1.55
  front_overhang: 0.85
  rear_overhang: 0.95
  width: 1.8
  height: 1.5
cameras:
  - name: front
    camera_model: pinhole
    intrinsics: [300.5, 301.5, 319.5, 199.5]
    distortion_model: equidistant
    distortion_coeffs: [0.01, -0.002, 0.0003, -4e-05]
    resolution: [640, 400]
    T_vehicle_cam:
      - [0, 0, 1, 3.6]
      - [-1, 0, 0, 0.1]
      - [0, -1, 0, 0.7]
      - [0, 0, 0, 1]
    time_offset: -0.0125
    rate: 10
    mask: masks/front.png
  - name: rear
    camera_model: omni
    intrinsics: [1.1, 700, 701, 639.5, 399.5]
    distortion_model: none
    resolution: [1280, 800]
    T_vehicle_cam: [0, 0, -1, -0.9, 1, 0, 0, 0, 0, -1, 0, 0.8, 0, 0, 0, 1]
imu:
  T_vehicle_imu: {rows: 4, cols: 4, data: [1, 0, 0, 1.4, 0, 1, 0, 0, 0, 0, 1, 0.5, 0, 0, 0, 1]}
  gyroscope_noise_density: 1e-4
  gyroscope_random_walk: 2e-5
  accelerometer_noise_density: 3e-3
  accelerometer_random_walk: 4e-4
  rate: 200
)";

class RigYaml : public TestFolder {
 protected:
  std::string errorOf(const std::string& text) const {
    const Result<Rig> rig = readRig(write("rig.yaml", text));
    EXPECT_FALSE(rig.ok());
    return rig.ok() ? "" : rig.error().message;
  }
};

TEST_F(RigYaml, ReadsEveryField) {
  const Result<Rig> rig = readRig(write("rig.yaml", kRig));
  ASSERT_TRUE(rig.ok()) << rig.error().message;
  EXPECT_EQ(rig->name, "two cameras");
  ASSERT_EQ(rig->cameras.size(), 2U);
  const RigCamera& front = rig->cameras[0];
  EXPECT_EQ(front.name, "front");
  EXPECT_STREQ(front.camera.modelName(), "pinhole-equidistant");
  EXPECT_EQ(front.camera.width(), 640);
  EXPECT_EQ(front.camera.height(), 400);
  const auto& p = std::get<PinholeEquidistant>(front.camera.model()).parameters();
  EXPECT_EQ(p.fx, 300.5);
  EXPECT_EQ(p.cy, 199.5);
  EXPECT_EQ(p.k4, -4e-5);
  EXPECT_EQ(front.time_offset_ns, -12'500'000);
  EXPECT_EQ(front.rate_hz, 10.0);
  EXPECT_EQ(front.mask_path, path("masks/front.png"));
  // The front camera looks ahead: its optical axis is the vehicle's x axis.
  EXPECT_LT(
      (front.T_vehicle_cam * Eigen::Vector3d(0, 0, 2) - Eigen::Vector3d(5.6, 0.1, 0.7)).norm(),
      1e-12);
  EXPECT_STREQ(rig->cameras[1].camera.modelName(), "omni-radtan");
  EXPECT_EQ(rig->cameras[1].time_offset_ns, 0);
  EXPECT_EQ(rig->imu.T_vehicle_imu.translation(), Eigen::Vector3d(1.4, 0.0, 0.5));
  EXPECT_EQ(rig->imu.accelerometer_random_walk, 4e-4);
  ASSERT_TRUE(rig->vehicle.has_value());
  EXPECT_EQ(rig->vehicle->rear_overhang, 0.95);
}

Rig randomRig(Random& random) {
  Rig rig;
  rig.name = "a \"quoted\" rig: # with \\ signs";
  rig.vehicle = VehicleShape{};
  rig.vehicle->wheelbase = random.uniform(2.0, 3.0);
  const auto number = [&] { return random.normal(); };
  RadtanDistortion distortion{
      0.1 * number(), 1e-2 * number(), 1e-3 * number(), 1e-3 * number(), 0.0, 0.0, 0.0, 0.0};
  Ocam::Parameters ocam;
  ocam.world2cam = {50.0 * M_PI, 100.0};
  ocam.cam2world = {-100.0, 0.0, 1e-3 * number()};
  ocam.affine << 1.0 + 1e-3 * number(), 1e-3 * number(), 1e-3 * number(), 1.0;
  ocam.cx = 300.0 + number();
  ocam.cy = 200.0 + number();
  const double f = 300.0 + number();
  std::vector<CameraModel> models = {
      PinholeRadtan({f, f + number(), 320.0 + number(), 200.0 + number(), distortion}),
      PinholeEquidistant({f, f, 320.0, 200.0, 1e-2 * number(), 1e-3 * number(), 0.0, 1e-5}),
      Ocam(ocam)};
  distortion.k3 = 1e-3 * number();
  models.emplace_back(Mei({1.0 + 0.1 * number(), f, f, 320.0, 200.0, distortion}));
  distortion.k4 = 1e-2 * std::abs(number());
  models.emplace_back(PinholeRadtan({f, f, 1.0 / 3.0, 1e-7, distortion}));
  for (std::size_t i = 0; i < models.size(); ++i) {
    RigCamera camera;
    camera.name = "cam" + std::to_string(i);
    camera.camera = Camera(models[i], 640, 400);
    camera.T_vehicle_cam =
        SE3(SO3::exp({number(), number(), number()}), {number(), number(), number()});
    camera.time_offset_ns = random.integer(-1'000'000'000, 1'000'000'000);
    camera.rate_hz = 10.0 / 3.0;
    camera.readout_time = i == 0 ? 0.0 : 0.1 / 3.0;
    rig.cameras.push_back(camera);
  }
  rig.imu.T_vehicle_imu = rig.cameras[0].T_vehicle_cam;
  rig.imu.gyroscope_noise_density = std::abs(number());
  return rig;
}

TEST_F(RigYaml, WritesWhatItReadsBackExactly) {
  Random random(11);
  for (int i = 0; i < 20; ++i) {
    Rig rig = randomRig(random);
    rig.cameras[1].mask_path = path("masks/1.png");
    rig.cameras[2].mask_path = "/elsewhere/2.png";
    rig.cameras[1].position_sigma = 0.0028;
    rig.cameras[1].rotation_sigma = 0.012 * kDegree;
    ASSERT_TRUE(writeRig(rig, path("rig.yaml")).ok());
    const Result<Rig> back = readRig(path("rig.yaml"));
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_EQ(back->name, rig.name);
    EXPECT_EQ(back->vehicle->wheelbase, rig.vehicle->wheelbase);
    ASSERT_EQ(back->cameras.size(), rig.cameras.size());
    for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
      const RigCamera& a = rig.cameras[k];
      const RigCamera& b = back->cameras[k];
      EXPECT_EQ(a.name, b.name);
      EXPECT_EQ(a.mask_path, b.mask_path);
      EXPECT_EQ(a.position_sigma, b.position_sigma);
      EXPECT_DOUBLE_EQ(a.rotation_sigma, b.rotation_sigma);
      EXPECT_EQ(a.time_offset_ns, b.time_offset_ns);
      EXPECT_EQ(a.rate_hz, b.rate_hz);
      EXPECT_EQ(a.readout_time, b.readout_time);
      EXPECT_EQ(a.T_vehicle_cam.translation(), b.T_vehicle_cam.translation());
      EXPECT_LT((a.T_vehicle_cam.matrix() - b.T_vehicle_cam.matrix()).cwiseAbs().maxCoeff(), 2e-15);
      // The same model to the bit projects to the same bits.
      const Eigen::Vector3d p(0.2, -0.1, 1.0);
      Eigen::Vector2d pixel_a;
      Eigen::Vector2d pixel_b;
      ASSERT_TRUE(a.camera.project(p, pixel_a));
      ASSERT_TRUE(b.camera.project(p, pixel_b));
      EXPECT_EQ(pixel_a, pixel_b);
    }
    EXPECT_EQ(back->imu.gyroscope_noise_density, rig.imu.gyroscope_noise_density);
    EXPECT_EQ(back->imu.rate_hz, rig.imu.rate_hz);
  }
}

TEST_F(RigYaml, WritingFailsWithTheName) {
  const Status status = writeRig(Rig{}, path("absent/rig.yaml"));
  ASSERT_FALSE(status.ok());
  EXPECT_THAT(status.error().message, HasSubstr("absent/rig.yaml"));
}

TEST_F(RigYaml, ReportsAMissingFile) {
  const Result<Rig> rig = readRig(path("none.yaml"));
  ASSERT_FALSE(rig.ok());
  EXPECT_THAT(rig.error().message, HasSubstr("none.yaml"));
}

struct BadInput {
  const char* name;
  const char* part;
  const char* with;
  std::vector<const char*> message;  // parts of it, the file's name and line among them
};

std::ostream& operator<<(std::ostream& stream, const BadInput& input) {
  return stream << input.name;
}

class BadRigYaml : public TestFolder, public testing::WithParamInterface<BadInput> {};

TEST_P(BadRigYaml, IsRefusedWithFileLineKeyAndValue) {
  const BadInput& input = GetParam();
  const Result<Rig> rig = readRig(write("rig.yaml", replaced(kRig, input.part, input.with)));
  ASSERT_FALSE(rig.ok());
  for (const char* part : input.message) EXPECT_THAT(rig.error().message, HasSubstr(part));
}

INSTANTIATE_TEST_SUITE_P(
    Inputs, BadRigYaml,
    testing::Values(
        BadInput{"NotARotation",
                 "- [-1, 0, 0, 0.1]",
                 "- [-1, 0.1, 0, 0.1]",
                 {"rig.yaml:17: cameras[0].T_vehicle_cam:", "not a rotation", "-1, 0.1, 0"}},
        BadInput{"Reflection",
                 "- [-1, 0, 0, 0.1]",
                 "- [1, 0, 0, 0.1]",
                 {"rig.yaml:17: cameras[0].T_vehicle_cam:", "not a rotation", "det R = -1"}},
        BadInput{"LastRow",
                 "- [0, 0, 0, 1]",
                 "- [0, 0, 0, 2]",
                 {"rig.yaml:17: cameras[0].T_vehicle_cam:", "last row", "0 0 0 2"}},
        BadInput{"MatrixTooShort",
                 "- [0, 0, 0, 1]",
                 "- [0, 0, 1]",
                 {"rig.yaml:17: cameras[0].T_vehicle_cam:", "16", "15"}},
        BadInput{"NanInMatrix",
                 "- [-1, 0, 0, 0.1]",
                 "- [-1, 0, 0, .nan]",
                 {"rig.yaml:18: cameras[0].T_vehicle_cam", "finite", "'.nan'"}},
        BadInput{"NanInIntrinsics",
                 "[300.5, 301.5, 319.5",
                 "[nan, 301.5, 319.5",
                 {"rig.yaml:12: cameras[0].intrinsics", "finite", "'nan'"}},
        BadInput{"TextInCoefficients",
                 "-4e-05",
                 "many",
                 {"rig.yaml:14: cameras[0].distortion_coeffs", "finite", "'many'"}},
        BadInput{"UnknownCameraModel",
                 "camera_model: omni",
                 "camera_model: eucm",
                 {"rig.yaml:25: cameras[1].camera_model:", "'eucm'", "pinhole, omni, ocam"}},
        BadInput{"UnknownDistortion",
                 "distortion_model: equidistant",
                 "distortion_model: fov",
                 {"rig.yaml:13: cameras[0].distortion_model:", "'fov'", "equidistant"}},
        BadInput{"DistortionOfAnotherModel",
                 "distortion_model: none",
                 "distortion_model: equidistant",
                 {"rig.yaml:27: cameras[1].distortion_model:", "'equidistant'", "radtan, none"}},
        BadInput{"TooFewCoefficients",
                 ", -4e-05]",
                 "]",
                 {"rig.yaml:14: cameras[0].distortion_coeffs:", "expected 4", "found 3"}},
        BadInput{"TooManyIntrinsics",
                 "319.5, 199.5]",
                 "319.5, 199.5, 1]",
                 {"rig.yaml:12: cameras[0].intrinsics:", "expected 4", "found 5"}},
        BadInput{"ZeroFocalLength",
                 "[300.5, 301.5",
                 "[0, 301.5",
                 {"rig.yaml:12: cameras[0].intrinsics:", "0 and 301.5 must be > 0"}},
        BadInput{"NegativeXi",
                 "[1.1, 700",
                 "[-1.1, 700",
                 {"rig.yaml:26: cameras[1].intrinsics:", "xi = -1.1"}},
        BadInput{"ZeroResolution",
                 "[640, 400]",
                 "[640, 0]",
                 {"rig.yaml:15: cameras[0].resolution:", "640 x 0"}},
        BadInput{"NegativeResolution",
                 "[640, 400]",
                 "[-640, 400]",
                 {"rig.yaml:15: cameras[0].resolution:", "-640 x 400"}},
        BadInput{"ResolutionOfNoPicture",
                 "[640, 400]",
                 "[640, 65536]",
                 {"rig.yaml:15: cameras[0].resolution:", "640 x 65536", "65535"}},
        BadInput{"FractionalResolution",
                 "[640, 400]",
                 "[640, 400.5]",
                 {"rig.yaml:15: cameras[0].resolution[1]:", "'400.5'"}},
        BadInput{"ResolutionOfThree",
                 "[640, 400]",
                 "[640, 400, 3]",
                 {"rig.yaml:15: cameras[0].resolution:", "[width, height]"}},
        BadInput{"UnknownCameraKey",
                 "    rate: 10",
                 "    rat: 10",
                 {"rig.yaml:22: cameras[0]: unknown key 'rat'", "rate"}},
        BadInput{"UnknownRootKey",
                 "name: two",
                 "nmae: two",
                 {"rig.yaml:1:", "unknown key 'nmae'", "name"}},
        BadInput{"MissingIntrinsics",
                 "    intrinsics: [300.5, 301.5, 319.5, 199.5]\n",
                 "",
                 {"rig.yaml:10: cameras[0]: missing key 'intrinsics'"}},
        BadInput{"MissingExtrinsics",
                 "    T_vehicle_cam: [0, 0, -1, -0.9",
                 "    mask: x #",
                 {"rig.yaml:24: cameras[1]: missing key 'T_vehicle_cam'"}},
        BadInput{"MissingNoise",
                 "  gyroscope_noise_density: 1e-4\n",
                 "",
                 {"imu: missing key 'gyroscope_noise_density'"}},
        BadInput{"NegativeNoise",
                 "accelerometer_noise_density: 3e-3",
                 "accelerometer_noise_density: -3e-3",
                 {"rig.yaml:34: imu.accelerometer_noise_density:", "> 0", "-0.003"}},
        BadInput{"ZeroRate", "rate: 200", "rate: 0", {"rig.yaml:36: imu.rate:", "> 0", "found 0"}},
        BadInput{"SameNameTwice",
                 "name: rear",
                 "name: front",
                 {"rig.yaml:24: cameras[1].name:", "two cameras", "'front'"}},
        BadInput{
            "NameWithSlash", "name: rear", "name: a/b", {"rig.yaml:24: cameras[1].name:", "'a/b'"}},
        BadInput{"HugeTimeOffset",
                 "-0.0125",
                 "1e12",
                 {"rig.yaml:21: cameras[0].time_offset:", "1000000000000"}},
        BadInput{"ReadoutInMilliseconds",
                 "    rate: 10",
                 "    readout_time: 30",
                 {"rig.yaml:22: cameras[0].readout_time:", "30 s", "ms"}},
        BadInput{"VehicleWithoutWidth", "  width: 1.8\n", "", {"vehicle: missing key 'width'"}},
        BadInput{"NotYaml", "cameras:", "cameras: [", {"rig.yaml", "not valid YAML"}}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(RigCamera, ReadsItsRowsAboutTheStamp) {
  RigCamera camera;
  camera.camera = Camera(PinholeEquidistant({300.0, 300.0, 320.0, 200.0}), 640, 401);
  EXPECT_EQ(camera.rowTime(17.0), 0.0);
  camera.readout_time = 0.03;
  EXPECT_DOUBLE_EQ(camera.rowTime(0.0), -0.015);
  EXPECT_DOUBLE_EQ(camera.rowTime(200.0), 0.0);
  EXPECT_DOUBLE_EQ(camera.rowTime(400.0), 0.015);
  EXPECT_DOUBLE_EQ(camera.rowTime(4000.0), 0.015);
}

TEST_F(RigYaml, RefusesAnEmptyListOfCameras) {
  const std::string text = std::string(kRig);
  const std::size_t from = text.find("cameras:");
  const std::size_t to = text.find("imu:");
  EXPECT_THAT(errorOf(text.substr(0, from) + "cameras: []\n" + text.substr(to)),
              HasSubstr("rig.yaml:9: cameras: expected a list of cameras"));
}

TEST_F(RigYaml, RefusesAnOcamThatDoesNotStartAtItsCentre) {
  const std::string text = replaced(kRig,
                                    "camera_model: omni\n"
                                    "    intrinsics: [1.1, 700, 701, 639.5, 399.5]\n"
                                    "    distortion_model: none",
                                    "camera_model: ocam\n"
                                    "    intrinsics: [639.5, 399.5, 1, 0, 0, 1]\n"
                                    "    distortion_model: polynomial\n"
                                    "    distortion_coeffs: [600.0, 300.0]");
  EXPECT_THAT(errorOf(text),
              HasSubstr("rig.yaml:28: cameras[1].distortion_coeffs: world2cam gives "));
  EXPECT_TRUE(readRig(write("rig.yaml", replaced(text, "[600.0", "[471.3"))).ok());
}

TEST_F(RigYaml, SubsetKeepsTheOrderAskedFor) {
  const Result<Rig> rig = readRig(write("rig.yaml", kRig));
  ASSERT_TRUE(rig.ok());
  EXPECT_EQ(rig->find("rear"), 1);
  EXPECT_EQ(rig->find("left"), -1);
  const Result<Rig> swapped = rig->subset({"rear", "front"});
  ASSERT_TRUE(swapped.ok());
  EXPECT_EQ(swapped->find("rear"), 0);
  EXPECT_EQ(swapped->find("front"), 1);
  EXPECT_EQ(swapped->imu.rate_hz, 200.0);
  const Result<Rig> unknown = rig->subset({"front", "left"});
  ASSERT_FALSE(unknown.ok());
  EXPECT_THAT(unknown.error().message, HasSubstr("'left'"));
  EXPECT_THAT(unknown.error().message, HasSubstr("front, rear"));
  EXPECT_FALSE(rig->subset({"front", "front"}).ok());
}

}  // namespace
}  // namespace parkade
