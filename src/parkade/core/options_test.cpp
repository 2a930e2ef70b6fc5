// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/core/options.hpp"

#include <gmock/gmock.h>

#include <cstdio>
#include <fstream>
#include <string>

#include "parkade/core/yaml.hpp"

namespace parkade {
namespace {

using ::testing::HasSubstr;

struct WindowOptions {
  int keyframes = 8;
  double max_gap_s = 0.1;
  void visit(OptionVisitor& v) {
    v.field("keyframes", keyframes, "count", "Keyframes kept in the window.", 2, 50);
    v.field("max_gap_s", max_gap_s, "s", "Longest gap between readings.", 0.0);
  }
};

struct TestOptions {
  WindowOptions window;
  bool loop = true;
  std::string method = "fused";
  void visit(OptionVisitor& v) {
    v.group("window", window);
    v.field("loop", loop, "Close loops.");
    v.field("method", method, "What runs.", {"fused", "vis"});
  }
};

class OptionsTest : public ::testing::Test {
 protected:
  std::string write(const std::string& text) {
    // Cases run side by side in programs of their own: each has its own file.
    const std::string path = ::testing::TempDir() + "parkade_options_" +
                             ::testing::UnitTest::GetInstance()->current_test_info()->name() +
                             ".yaml";
    std::ofstream(path) << text;
    return path;
  }
  TestOptions options_;
  OptionTree tree_ = asOptions(options_);
};

TEST_F(OptionsTest, SetsFieldsByDottedName) {
  ASSERT_TRUE(setOption(tree_, "window.keyframes=12"));
  ASSERT_TRUE(setOption(tree_, "loop=false"));
  ASSERT_TRUE(setOption(tree_, "method=vis"));
  ASSERT_TRUE(setOption(tree_, "window.max_gap_s=2.5e-1"));
  EXPECT_EQ(options_.window.keyframes, 12);
  EXPECT_FALSE(options_.loop);
  EXPECT_EQ(options_.method, "vis");
  EXPECT_EQ(options_.window.max_gap_s, 0.25);
}

TEST_F(OptionsTest, RefusesBadValuesAndSaysWhy) {
  const auto message = [&](const std::string& assignment) {
    const Status status = setOption(tree_, assignment);
    EXPECT_FALSE(status) << assignment;
    return status ? std::string() : status.error().message;
  };
  EXPECT_THAT(message("window.keyframes=1"), HasSubstr("expected 2 to 50 (count), found '1'"));
  EXPECT_THAT(message("window.keyframes=8.5"), HasSubstr("whole number"));
  EXPECT_THAT(message("window.max_gap_s=nan"), HasSubstr("expected a number (s), found 'nan'"));
  EXPECT_THAT(message("loop=maybe"), HasSubstr("true or false"));
  EXPECT_THAT(message("method=magic"), HasSubstr("one of fused, vis"));
  EXPECT_THAT(message("window.keyframe=9"), HasSubstr("did you mean: window.keyframes"));
  EXPECT_THAT(message("keyframes"), HasSubstr("NAME=VALUE"));
  EXPECT_EQ(options_.window.keyframes, 8);
}

TEST_F(OptionsTest, FileSetsAndDumpReadsBack) {
  ASSERT_TRUE(
      loadOptions(tree_, write("window:\n  keyframes: 20\n  max_gap_s: 0.3\nloop: false\n")));
  EXPECT_EQ(options_.window.keyframes, 20);
  options_.window.max_gap_s = 0.1 + 0.2;  // needs all 17 digits
  TestOptions copy;
  ASSERT_TRUE(loadOptions(asOptions(copy), write(dumpOptions(tree_))));
  EXPECT_EQ(copy.window.max_gap_s, options_.window.max_gap_s);
  EXPECT_EQ(copy.loop, options_.loop);
  EXPECT_EQ(copy.method, options_.method);
}

TEST_F(OptionsTest, FileErrorsNameFileLineAndKeyAndChangeNothing) {
  const std::string path = write("window:\n  keyframes: 20\n  keyframs: 3\n");
  const Status status = loadOptions(tree_, path);
  ASSERT_FALSE(status);
  EXPECT_THAT(status.error().message, HasSubstr(path + ":3"));
  EXPECT_THAT(status.error().message, HasSubstr("window.keyframs"));
  EXPECT_EQ(options_.window.keyframes, 8);
  EXPECT_THAT(loadOptions(tree_, "/nowhere/at.yaml").error().message,
              HasSubstr("/nowhere/at.yaml"));
  EXPECT_THAT(loadOptions(tree_, write("a: [1, 2\n")).error().message, HasSubstr("not valid YAML"));
}

TEST_F(OptionsTest, DescribesEveryField) {
  const std::string text = describeOptions(tree_);
  EXPECT_THAT(text, HasSubstr("window.keyframes"));
  EXPECT_THAT(text, HasSubstr("Keyframes kept in the window."));
  EXPECT_THAT(text, HasSubstr("[2 to 50]"));
  EXPECT_THAT(text, HasSubstr("[fused|vis]"));
}

TEST(YamlNode, ReadsAText) {
  const Result<YamlNode> root = openYamlText("%YAML:1.0\na: 3\n", "preset");
  ASSERT_TRUE(root.ok());
  EXPECT_EQ(root->at("a").asInt(), 3);
  const Result<YamlNode> bad = openYamlText("a: [1, 2", "preset");
  ASSERT_FALSE(bad.ok());
  EXPECT_EQ(bad.error().message.rfind("preset:", 0), 0U) << bad.error().message;
}

TEST(YamlNode, RefusesWhatYamlWouldDropOrNeverEnd) {
  const auto problem = [](const char* text) {
    const Result<YamlNode> root = openYamlText(text, "f.yaml");
    return root.ok() ? std::string("none") : root.error().message;
  };
  EXPECT_EQ(problem("a: 1\nb: {c: 1}\n"), "none");
  EXPECT_EQ(problem("x: &v [1, 2]\ny: *v\n"), "none");
  EXPECT_THAT(problem("a: 1\nb: 2\na: 3\n"), HasSubstr("f.yaml:3: key 'a' stands twice"));
  EXPECT_THAT(problem("a: &v\n  b: *v\n"), HasSubstr("an alias within itself"));
  EXPECT_THAT(problem("a: &v [1, *v]\n"), HasSubstr("an alias within itself"));
  EXPECT_THAT(problem("? [a, b]\n: 1\n"), HasSubstr("f.yaml:1: a key must be plain text"));
  EXPECT_THAT(problem("a: 1\n---\nb: 2\n"), HasSubstr("second document"));
}

TEST(YamlNode, ReadsMatricesAndNamesWhatIsWrong) {
  const std::string path = ::testing::TempDir() + "parkade_yaml_test.yaml";
  std::ofstream(path) << "%YAML:1.0\n---\nflat: [1,0,0,1, 0,1,0,2, 0,0,1,3, 0,0,0,1]\n"
                         "nested: [[1,0,0,1],[0,1,0,2],[0,0,1,3],[0,0,0,1]]\n"
                         "cv: {rows: 4, cols: 4, data: [1,0,0,1, 0,1,0,2, 0,0,1,3, 0,0,0,1]}\n"
                         "short: [1, 2]\nbad: [1, .nan]\n";
  Result<YamlNode> root = openYaml(path);
  ASSERT_TRUE(root) << root.error().message;
  EXPECT_EQ(root->at("flat").asMatrix4(), root->at("nested").asMatrix4());
  EXPECT_EQ(root->at("flat").asMatrix4(), root->at("cv").asMatrix4());
  const auto message = [&](const std::function<void()>& f) -> std::string {
    try {
      f();
    } catch (const YamlError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(message([&] { static_cast<void>(root->at("short").asMatrix4()); }),
              HasSubstr(":6: short: expected 16 numbers, found 2"));
  EXPECT_THAT(message([&] { static_cast<void>(root->at("bad").asDoubles()); }),
              HasSubstr("bad[1]"));
  EXPECT_THAT(message([&] { static_cast<void>(root->at("absent")); }),
              HasSubstr("missing key 'absent'"));
  EXPECT_THAT(message([&] {
                root->allowOnly({"flat", "nested", "cv", "short"});
              }),
              HasSubstr("unknown key 'bad'"));
}

}  // namespace
}  // namespace parkade
