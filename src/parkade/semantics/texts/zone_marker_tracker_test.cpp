// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/texts/zone_marker_tracker.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>

#include "parkade/core/random.hpp"

namespace parkade {
namespace {

constexpr double kPixel = 1.0 / 145.0;  // rad, of a label picture

std::vector<std::vector<TextReading>> says(const std::string& text, double probability) {
  return {{{text, probability}, {"", 1.0 - probability}}};
}

// A marker of that height as an eye sees it; noise in units of its sigmas.
ZoneMarkerView viewOf(const Eigen::Vector3d& marker, double height, const Eigen::Vector3d& eye,
                      Random* random) {
  ZoneMarkerView view;
  view.eye = eye;
  view.sigma = kPixel;
  view.height_sigma = 0.5 * kPixel;
  const Eigen::Vector3d d = marker - eye;
  view.ray = d.normalized();
  view.height_ratio = height / d.head<2>().norm();
  if (random != nullptr) {
    const auto jitter = [&] { return random->normal(0.0, kPixel); };
    view.ray = (view.ray + Eigen::Vector3d(jitter(), jitter(), jitter())).normalized();
    view.height_ratio += random->normal(0.0, view.height_sigma);
  }
  return view;
}

TEST(ZoneMarkerTracker, NoiseFreeViewsGiveThePlaceExactly) {
  ZoneMarkerTrackerOptions options;
  options.told_sigma_m = 0.5;
  ZoneMarkerTracker tracker(options);
  const Eigen::Vector3d marker(6.0, 3.0, 1.7);
  // As high as is expected, so that the prior of the height does not pull.
  for (int k = 0; k < 8; ++k) {
    ZoneMarkerView view =
        viewOf(marker, options.height_m, Eigen::Vector3d(0.7 * k, 0.0, 0.9), nullptr);
    view.readings = says("B12", 0.9);
    tracker.add({view}, k * TimeNs{100000000});
  }
  const auto told = tracker.takeTold();
  ASSERT_EQ(told.size(), 1U);
  EXPECT_LT((told[0].position - marker).norm(), 1e-4);
  EXPECT_EQ(told[0].text, "B12");
  EXPECT_GT(told[0].confidence, 0.999);
  EXPECT_EQ(told[0].views, 8);
  EXPECT_TRUE(tracker.takeTold().empty());  // not twice from the same views
}

TEST(ZoneMarkerTracker, CovarianceTellsTheErrorOfNoisyViews) {
  Random random(11);
  ZoneMarkerTrackerOptions options;
  options.place_sigma_m = 1e-3;  // these markers have no faces
  options.told_sigma_m = 1.0;
  double nees = 0.0;
  double worst = 0.0;
  constexpr int kTrials = 100;
  for (int trial = 0; trial < kTrials; ++trial) {
    ZoneMarkerTracker tracker(options);
    const Eigen::Vector3d marker(random.uniform(3.0, 7.0), random.uniform(2.0, 5.0), 1.7);
    const double height = random.uniform(0.45, 0.8);
    for (int k = 0; k < 10; ++k) {
      ZoneMarkerView view = viewOf(marker, height, Eigen::Vector3d(0.6 * k, 0.0, 0.9), &random);
      view.readings = says("C3", 0.7);
      tracker.add({view}, k * TimeNs{100000000});
    }
    // One view in a thousand fails the gate and begins a marker of its own.
    const auto found = tracker.followed();
    ASSERT_LE(found.size(), 2U) << trial;
    ASSERT_GE(found[0].views, 9) << trial;
    const Eigen::Vector3d error = found[0].position - marker;
    nees += error.dot(found[0].covariance.llt().solve(error)) / 3.0 / kTrials;
    worst = std::max(worst, error.norm());
  }
  EXPECT_LT(worst, 0.4);
  EXPECT_GT(nees, 0.3);  // not far too careful either
  EXPECT_LT(nees, 1.5);
}

TEST(ZoneMarkerTracker, AViewThatSurelyReadsAnotherTextIsOfAnotherMarker) {
  const auto followedWith = [](const std::vector<std::vector<TextReading>>& last) {
    ZoneMarkerTracker tracker({});
    for (int k = 0; k < 7; ++k) {
      ZoneMarkerView view = viewOf({6.0, 3.0, 1.7}, 0.6, {0.5 * k, 0.0, 0.9}, nullptr);
      view.readings = k < 6 ? says("B12", 0.9) : last;
      tracker.add({view}, k * TimeNs{100000000});
    }
    return tracker.followed().size();
  };
  EXPECT_EQ(followedWith({}), 1U);
  EXPECT_EQ(followedWith(says("B12", 0.95)), 1U);
  EXPECT_EQ(followedWith(says("B1", 0.95)), 1U);    // a part of it
  EXPECT_EQ(followedWith(says("B12B", 0.95)), 1U);  // two faces
  EXPECT_EQ(followedWith(says("C12", 0.7)), 1U);    // may be misread
  EXPECT_EQ(followedWith(says("C12", 0.95)), 2U);
}

TEST(ZoneMarkerTracker, WhatIsKnownNeedsReadingNowAndThen) {
  const Eigen::Vector3d marker(6.0, 3.0, 1.7);
  const auto view = [&](int k) { return viewOf(marker, 0.6, {0.3 * k, 0.0, 0.9}, nullptr); };
  for (const double sure : {0.95, 0.5}) {
    SCOPED_TRACE(sure);
    ZoneMarkerTracker tracker({});
    EXPECT_FALSE(tracker.needsNoReading(view(0)));
    int skipped = 0;
    for (int k = 0; k < 20; ++k) {
      ZoneMarkerView seen = view(k);
      if (k > 1) {
        skipped += tracker.needsNoReading(seen) ? 1 : 0;
      }
      if (k == 2) {
        EXPECT_EQ(skipped, 0);  // two readings are not enough
      }
      seen.readings = says(k % 2 == 0 || sure > 0.9 ? "B12" : "B13", sure);
      tracker.add({seen}, k * TimeNs{100000000});
    }
    EXPECT_EQ(skipped, sure > 0.9 ? 10 : 0);
    for (int k = 20; k < 80; ++k) {  // more than are kept
      ZoneMarkerView seen = view(20);
      skipped += tracker.needsNoReading(seen) ? 1 : 0;
      seen.readings = says("B12", sure);
      tracker.add({seen}, k * TimeNs{100000000});
    }
    if (sure > 0.9) {
      EXPECT_EQ(skipped, 50);
    } else {
      EXPECT_LT(skipped, 40);
    }
    // Another direction, and a place where two may stand.
    EXPECT_FALSE(tracker.needsNoReading(viewOf({6.0, -3.0, 1.7}, 0.6, {6.0, 0.0, 0.9}, nullptr)));
    tracker.add({viewOf({6.1, 3.1, 1.7}, 0.6, {5.7, 0.0, 0.9}, nullptr),
                 viewOf({6.0, 3.0, 1.7}, 0.6, {5.7, 0.0, 0.9}, nullptr)},
                TimeNs{8100000000});
    EXPECT_FALSE(tracker.needsNoReading(view(20)));
  }
}

TEST(ZoneMarkerTracker, NeighboursStayApart) {
  Random random(4);
  ZoneMarkerTracker tracker({});
  const std::vector<Eigen::Vector3d> markers = {
      {4.0, 4.0, 1.7}, {9.0, 4.0, 1.7}, {14.0, 4.0, 1.7}, {9.0, -4.0, 1.7}};
  const std::vector<std::string> texts = {"A1", "A2", "A3", "B2"};
  std::map<std::string, Eigen::Vector3d> told;
  for (int k = 0; k < 30; ++k) {
    std::vector<ZoneMarkerView> views;
    for (std::size_t i = 0; i < markers.size(); ++i) {
      const Eigen::Vector3d eye(0.5 * k, 0.0, 0.9);
      if ((markers[i] - eye).norm() > 9.0) continue;
      views.push_back(viewOf(markers[i], 0.6, eye, &random));
      views.back().readings = says(texts[i], 0.8);
    }
    tracker.add(views, k * TimeNs{100000000});
    for (const ZoneMarker& marker : tracker.takeTold()) {
      const auto i = static_cast<std::size_t>(std::find(texts.begin(), texts.end(), marker.text) -
                                              texts.begin());
      ASSERT_LT(i, markers.size()) << marker.text;
      EXPECT_LT((marker.position - markers[i]).norm(), 1.0) << marker.text;
      told[marker.text] = marker.position;
    }
  }
  EXPECT_EQ(told.size(), 4U);
  EXPECT_EQ(tracker.followed().size(), 4U);
}

TEST(TextEvidence, ViewsOutvoteAWrongOne) {
  TextEvidence evidence;
  EXPECT_EQ(evidence.best().text, "");
  evidence.add({{"2", 0.95}, {"D-2", 0.01}});  // its left part was hidden
  EXPECT_EQ(evidence.best().text, "2");
  evidence.add({{"D-2", 0.9}, {"D2", 0.1}});
  EXPECT_EQ(evidence.best().text, "D-2");
  evidence.add({{"D-2", 0.6}, {"0-2", 0.3}});
  EXPECT_EQ(evidence.best().text, "D-2");
  EXPECT_GT(evidence.best().probability, 0.99);
}

// Dark, far faces: readings of all kinds, none of which is likely, "1" oftener than any other.
TEST(TextEvidence, NoiseThatLooksLikeAStrokeIsNoText) {
  TextEvidence evidence;
  for (int k = 0; k < 20; ++k) {
    evidence.add({{"1", 0.03}, {k % 2 == 0 ? "7" : "12", 0.02}, {"", 0.01}});
  }
  EXPECT_LT(evidence.best().probability, 0.9) << evidence.best().text;
  for (int k = 0; k < 3; ++k) evidence.add({{"B04", 0.4}, {"1", 0.03}});
  EXPECT_EQ(evidence.best().text, "B04");
  EXPECT_GT(evidence.best().probability, 0.9);
  TextEvidence sure;
  for (int k = 0; k < 3; ++k) sure.add({{"1", 0.9}});
  EXPECT_EQ(sure.best().text, "1");
  EXPECT_GT(sure.best().probability, 0.95);
}

TEST(TextFormat, OtherMarkersTellHowOneIsMadeUp) {
  EXPECT_EQ(TextFormat::patternOf("B12"), "A0");
  EXPECT_EQ(TextFormat::patternOf("C-3"), "A-0");
  EXPECT_EQ(TextFormat::patternOf("117KH"), "0AA");
  TextFormat format;
  EXPECT_EQ(format.logPrior("5H5"), 0.0);  // nothing is known yet
  TextEvidence evidence;
  evidence.add({{"5H5", 0.6}, {"5H", 0.3}});
  EXPECT_EQ(evidence.best(format).text, "5H5");
  for (int i = 0; i < 8; ++i) format.add(std::to_string(i + 3) + "K");
  EXPECT_EQ(evidence.best(format).text, "5H");
  // As often as "6K" may be read as "66": those who read it knew no better.
  TextEvidence misread;
  for (int i = 0; i < 2; ++i) misread.add({{"66", 0.7}, {"6K", 0.2}});
  EXPECT_EQ(misread.best().text, "66");
  EXPECT_EQ(misread.best(format).text, "6K");
  EXPECT_TRUE(format.isStray("66"));
  EXPECT_FALSE(format.isStray("66K"));
  // Many clear readings stand against it.
  for (int i = 0; i < 4; ++i) evidence.add({{"5H5", 0.95}});
  EXPECT_EQ(evidence.best(format).text, "5H5");
}

TEST(ZoneMarkerTracker, ACutViewBelongsToAMarkerThatIsFollowed) {
  const ZoneMarkerTrackerOptions options;
  ZoneMarkerTracker tracker(options);
  const Eigen::Vector3d marker(5.0, 3.0, 1.7);
  const auto eyeAt = [&](int k) -> Eigen::Vector3d {
    return marker + Eigen::Vector3d(0.5 * k - 4.0, -3.0, -0.8);
  };
  ZoneMarkerView cut = viewOf(marker, options.height_m, eyeAt(0), nullptr);
  cut.whole = false;
  cut.sigma = 0.1;
  cut.height_sigma = cut.height_ratio;
  cut.readings = says("B7", 0.99);
  tracker.add({cut}, 0);
  EXPECT_TRUE(tracker.followed().empty());
  for (int k = 1; k < 8; ++k) {
    tracker.add({viewOf(marker, options.height_m, eyeAt(k), nullptr)}, k * TimeNs{100000000});
  }
  const Eigen::Vector3d before = tracker.followed().at(0).position;
  cut = viewOf(marker, options.height_m, eyeAt(8), nullptr);
  cut.whole = false;
  cut.sigma = 0.1;
  cut.height_ratio *= 0.7;  // the top is hidden
  cut.height_sigma = cut.height_ratio;
  cut.readings = says("B7", 0.99);
  tracker.add({cut}, 900'000'000);
  ASSERT_EQ(tracker.followed().size(), 1U);
  EXPECT_EQ(tracker.followed()[0].text, "B7");
  EXPECT_LT((tracker.followed()[0].position - before).norm(), 0.02);
}

TEST(ZoneMarkerTracker, LearnsHowMarkersAreCalled) {
  ZoneMarkerTrackerOptions options;
  options.forget_s = 1.0;
  options.told_sigma_m = 0.5;
  ZoneMarkerTracker tracker(options);
  TimeNs t_ns = 0;
  const auto pass = [&](const Eigen::Vector3d& marker,
                        const std::vector<std::vector<TextReading>>& readings, int times) {
    for (int k = 0; k < 8; ++k) {
      ZoneMarkerView view = viewOf(marker, options.height_m,
                                   marker + Eigen::Vector3d(0.7 * k - 5.0, -3.0, -0.8), nullptr);
      if (k < times) view.readings = readings;
      tracker.add({view}, t_ns);
      t_ns += 100'000'000;
    }
    const std::vector<ZoneMarker> told = tracker.takeTold();
    t_ns += 2'000'000'000;
    return told.empty() ? std::string() : told.front().text;
  };
  const std::vector<std::vector<TextReading>> doubtful = {{{"5H5", 0.6}, {"5H", 0.3}}};
  options.told_confidence = 0.0;
  tracker = ZoneMarkerTracker(options);
  EXPECT_EQ(pass({5.0, 3.0, 1.7}, doubtful, 1), "5H5");
  for (int i = 0; i < 6; ++i)
    pass({100.0 + 50.0 * i, 3.0, 1.7}, says(std::to_string(i) + "K", 0.99), 3);
  EXPECT_EQ(pass({600.0, 3.0, 1.7}, doubtful, 1), "5H");
}

TEST(TextEvidence, PartsSpeakForTheWhole) {
  TextEvidence evidence;
  for (const char* part : {"12", "2F", "12"}) evidence.add({{part, 0.9}});
  evidence.add({{"12F", 0.9}});
  EXPECT_EQ(evidence.best().text, "12F");
  // But a letter too many, once, does not outvote a short text.
  TextEvidence whole;
  for (int k = 0; k < 6; ++k) whole.add({{"B1", 0.9}});
  whole.add({{"B17", 0.9}});
  EXPECT_EQ(whole.best().text, "B1");
}

TEST(TextEvidence, NamesThatRepeatThemselvesStay) {
  for (const char* name : {"101", "11", "A11", "C-1", "111", "1A"}) {
    TextEvidence evidence;
    for (int k = 0; k < 3; ++k) evidence.add({{name, 0.9}});
    EXPECT_EQ(evidence.best().text, name);
  }
}

TEST(ZoneMarkerTracker, WhatNobodyReadsIsNotTold) {
  ZoneMarkerTracker tracker({});
  for (int k = 0; k < 20; ++k) {
    ZoneMarkerView view = viewOf({6.0, 3.0, 1.7}, 0.6, Eigen::Vector3d(0.4 * k, 0.0, 0.9), nullptr);
    view.readings = {{{"", 0.99}, {"1", 0.01}}};
    tracker.add({view}, k * TimeNs{100000000});
  }
  EXPECT_EQ(tracker.followed().size(), 1U);
  EXPECT_TRUE(tracker.takeTold().empty());
}

}  // namespace
}  // namespace parkade
