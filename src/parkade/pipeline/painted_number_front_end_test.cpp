// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/painted_number_front_end.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "parkade/core/random.hpp"
#include "parkade/semantics/markings/painted_number_test_support.hpp"

namespace parkade {
namespace {

using testing::HasSubstr;

class PaintedNumberDrive : public testing::Test {
 protected:
  PaintedNumberDrive() {
    rig_.cameras = {NumberedSlot::camera()};
    options_.reader = std::string(PARKADE_SOURCE_DIR) + "/models/zone_text.yaml";
  }

  [[nodiscard]] Result<std::unique_ptr<PaintedNumberFrontEnd>> create() const {
    return PaintedNumberFrontEnd::create(rig_, {}, options_);
  }

  // Passes the slot in steps of 0.2 m; what was read in each frame.
  std::vector<SemanticFrame> pass(PaintedNumberFrontEnd& front_end, NumberedSlot slot,
                                  double noise) {
    std::vector<SemanticFrame> frames;
    const double begin = slot.center.x() + 1.0;
    for (int k = 0; k <= 10; ++k) {
      slot.center.x() = begin - 0.2 * k;
      SemanticFrame frame = slot.frame();
      FrameSet pictures;
      pictures.images = {slot.see(rig_.cameras[0], noise, random_)};
      PoseEstimate odometry;
      odometry.T_odom_vehicle = SE3(SO3(), {0.2 * k, 0.0, 0.0});
      const BevViews views = BevViews::fromMiddle(frame.labels.geometry);
      const Status read = front_end.read(pictures, views, odometry, frame);
      EXPECT_TRUE(read) << read.error().message;
      frames.push_back(std::move(frame));
    }
    return frames;
  }

  Rig rig_;
  PaintedNumberFrontEndOptions options_;
  Random random_{11};
};

TEST_F(PaintedNumberDrive, ReadsANumberThatIsPassed) {
  for (const double noise : {0.0, 5.0}) {
    const auto front_end = create();
    ASSERT_TRUE(front_end) << front_end.error().message;
    NumberedSlot slot;
    slot.turn = 0.1;
    int read = 0;
    for (const SemanticFrame& frame : pass(**front_end, slot, noise)) {
      if (frame.slots[0].number.empty()) continue;
      ++read;
      EXPECT_EQ(frame.slots[0].number.front().text, "47") << noise;
      EXPECT_EQ(frame.objects[0].text, "47") << noise;
    }
    EXPECT_EQ(read, 6);  // every other step: 0.4 m apart
  }
}

TEST_F(PaintedNumberDrive, FindsOutThatNumbersFaceWhoLeaves) {
  const auto front_end = create();
  ASSERT_TRUE(front_end) << front_end.error().message;
  NumberedSlot slot;
  slot.leaves = true;
  const std::vector<SemanticFrame> frames = pass(**front_end, slot, 3.0);
  for (std::size_t k = 4; k < frames.size(); k += 2) {
    ASSERT_FALSE(frames[k].slots[0].number.empty());
    EXPECT_EQ(frames[k].slots[0].number.front().text, "47") << k;
  }
}

TEST_F(PaintedNumberDrive, ReadsASpeedLimitWhicheverWayItFaces) {
  for (const double turn : {0.0, 1.3, 3.2}) {
    options_.limits = "15 47";
    const auto front_end = create();
    ASSERT_TRUE(front_end) << front_end.error().message;
    NumberedSlot limit;
    limit.ring = 0.72;
    limit.turn = turn;
    int read = 0;
    for (const SemanticFrame& frame : pass(**front_end, limit, 3.0)) {
      if (frame.objects[0].text.empty()) continue;
      ++read;
      EXPECT_EQ(frame.objects[0].text, "47") << turn;
    }
    EXPECT_GE(read, 3) << turn;
  }
}

TEST_F(PaintedNumberDrive, SwitchedOffAndWrongFiles) {
  options_.enabled = false;
  auto front_end = create();
  ASSERT_TRUE(front_end);
  EXPECT_EQ(*front_end, nullptr);
  options_.enabled = true;
  options_.reader = "none.yaml";
  front_end = create();
  ASSERT_FALSE(front_end);
  EXPECT_THAT(front_end.error().message, HasSubstr("none.yaml"));
}

}  // namespace
}  // namespace parkade
