// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/image_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "parkade/io/jpeg.hpp"
#include "parkade/io/test_support.hpp"

namespace parkade {
namespace {

using test::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;

cv::Mat noise(int type) {
  cv::Mat image(48, 64, type);
  cv::RNG random(7);
  random.fill(image, cv::RNG::UNIFORM, 0, 256);
  return image;
}

TEST(ImageFile, PngKeepsEveryPixel) {
  const TemporaryFolder folder;
  for (const int type : {CV_8UC1, CV_8UC3}) {
    const cv::Mat image = noise(type);
    ASSERT_TRUE(writeImage(folder.path("a.png"), image, {true, 92, 3}).ok());
    const auto read = readImage(folder.path("a.png"), type == CV_8UC1);
    ASSERT_TRUE(read.ok()) << read.error().message;
    ASSERT_EQ(read->type(), type);
    EXPECT_EQ(cv::norm(*read, image, cv::NORM_INF), 0.0);
  }
}

TEST(ImageFile, GrayAndColourAreAsAsked) {
  const TemporaryFolder folder;
  ASSERT_TRUE(writeImage(folder.path("a.jpg"), noise(CV_8UC3), {}).ok());
  EXPECT_EQ(readImage(folder.path("a.jpg"), true)->type(), CV_8UC1);
  EXPECT_EQ(readImage(folder.path("a.jpg"), false)->type(), CV_8UC3);
  ASSERT_TRUE(writeImage(folder.path("b.png"), noise(CV_8UC1), {true, 92, 3}).ok());
  EXPECT_EQ(readImage(folder.path("b.png"), false)->type(), CV_8UC3);
}

TEST(ImageFile, GrayBesideColourIsTheGrayReadAlone) {
  const TemporaryFolder folder;
  for (const bool png : {false, true}) {
    for (const int type : {CV_8UC1, CV_8UC3}) {
      ASSERT_TRUE(writeImage(folder.path("a"), noise(type), {png, 92, 3}).ok());
      const auto both = readImageAndGray(folder.path("a"));
      ASSERT_TRUE(both.ok()) << both.error().message;
      const auto gray = readImage(folder.path("a"), true);
      const auto colour = readImage(folder.path("a"), false);
      EXPECT_EQ(cv::norm(both->gray, *gray, cv::NORM_INF), 0.0) << png << " " << type;
      EXPECT_EQ(cv::norm(both->image, *colour, cv::NORM_INF), 0.0) << png << " " << type;
    }
  }
  EXPECT_THAT(readImageAndGray(folder.write("b", "GIF89a")).error().message, HasSubstr("neither"));
}

// Recordings give the same bytes whichever reader decodes them.
TEST(ImageFile, JpegIsDecodedAsOpenCvDoes) {
  cv::Mat smooth;
  cv::resize(noise(CV_8UC3), smooth, {99, 131}, 0.0, 0.0, cv::INTER_CUBIC);
  for (const cv::Mat& image : {noise(CV_8UC3), noise(CV_8UC1), smooth}) {
    const std::string bytes = *encodeImage(image, {});
    const std::vector<char> raw(bytes.begin(), bytes.end());
    for (const bool gray : {false, true}) {
      const auto decoded = decodeJpeg(bytes, gray);
      ASSERT_TRUE(decoded.ok()) << decoded.error().message;
      ASSERT_TRUE(decoded->has_value());
      const cv::Mat expected = cv::imdecode(raw, gray ? cv::IMREAD_GRAYSCALE : cv::IMREAD_COLOR);
      ASSERT_EQ((*decoded)->type(), expected.type());
      EXPECT_EQ(cv::norm(**decoded, expected, cv::NORM_INF), 0.0) << gray;
    }
  }
}

TEST(ImageFile, TellsWhatIsWrongWithADamagedJpeg) {
  const TemporaryFolder folder;
  std::string bytes = *encodeImage(noise(CV_8UC3), {});
  const std::size_t frame = bytes.find("\xFF\xC0");
  ASSERT_NE(frame, std::string::npos);
  bytes[frame + 4] = 77;  // bits of a sample
  EXPECT_THAT(readImage(folder.write("a.jpg", bytes), false).error().message,
              AllOf(HasSubstr("a.jpg: the picture cannot be decoded"), HasSubstr("77")));
}

TEST(ImageFile, ADamagedPictureDoesNotSpoilTheNext) {
  const TemporaryFolder folder;
  const std::string whole = *encodeImage(noise(CV_8UC3), {});
  std::string damaged = whole;
  damaged[damaged.find("\xFF\xC0") + 4] = 77;
  const std::string a = folder.write("a.jpg", damaged);
  const std::string b = folder.write("b.jpg", whole);
  EXPECT_FALSE(readImage(a, false).ok());
  EXPECT_TRUE(readImage(b, false).ok());
}

// 60,000 x 60,000 pixels would take 11 GB.
TEST(ImageFile, RefusesSizesThatOnlyACorruptHeaderTells) {
  const TemporaryFolder folder;
  std::string jpeg = *encodeImage(noise(CV_8UC3), {});
  const std::size_t frame = jpeg.find("\xFF\xC0");
  ASSERT_NE(frame, std::string::npos);
  jpeg.replace(frame + 5, 4, "\xEA\x60\xEA\x60");
  std::string png = *encodeImage(noise(CV_8UC3), {true, 92, 3});
  png.replace(16, 8, std::string("\0\0\xEA\x60\0\0\xEA\x60", 8));
  for (const std::string& path : {folder.write("a.jpg", jpeg), folder.write("a.png", png)}) {
    const auto refused = AllOf(HasSubstr(path), HasSubstr("60000 x 60000 pixels"));
    EXPECT_THAT(readImage(path, true).error().message, refused);
    EXPECT_THAT(readImageAndGray(path).error().message, refused);
  }
  EXPECT_TRUE(checkImageSize(1 << 14, 1 << 13).ok());
  EXPECT_FALSE(checkImageSize(1 << 14, (1 << 13) + 1).ok());
  EXPECT_FALSE(checkImageSize(0xFFFFFFFF, 0xFFFFFFFF).ok());
}

TEST(ImageFile, FindsEveryCutOffFile) {
  const TemporaryFolder folder;
  for (const bool png : {false, true}) {
    const std::string whole = *encodeImage(noise(CV_8UC3), {png, 92, 3});
    ASSERT_TRUE(checkImageBytes(whole).ok());
    for (std::size_t size = 0; size < whole.size(); size += 1 + size / 7) {
      EXPECT_FALSE(checkImageBytes(whole.substr(0, size)).ok()) << png << " " << size;
    }
    const std::string path = folder.write("cut", whole.substr(0, whole.size() - 2));
    const auto read = readImage(path, true);
    ASSERT_FALSE(read.ok());
    EXPECT_THAT(read.error().message, AllOf(HasSubstr(path), HasSubstr("is cut off after")));
    // Recorders that preallocate leave zeros behind the end.
    EXPECT_TRUE(checkImageBytes(whole + std::string(100, '\0')).ok());
  }
}

TEST(ImageFile, AThumbnailsEndIsNotThePicturesEnd) {
  const std::string whole = *encodeImage(noise(CV_8UC1), {});
  // An APP1 segment with a whole small JPEG in it, right behind the start mark.
  const std::string inner = *encodeImage(cv::Mat(8, 8, CV_8UC1, cv::Scalar(9)), {});
  const std::size_t length = inner.size() + 2;
  const std::string segment = std::string("\xFF\xE1") + static_cast<char>(length >> 8) +
                              static_cast<char>(length & 0xFF) + inner;
  const std::string bytes = whole.substr(0, 2) + segment + whole.substr(2);
  EXPECT_TRUE(checkImageBytes(bytes).ok());
  EXPECT_TRUE(checkImageBytes(bytes + "notes of the recorder").ok());
  EXPECT_FALSE(checkImageBytes(bytes.substr(0, bytes.size() - 40)).ok());
}

TEST(ImageFile, FindsDamagedPngAndForeignFiles) {
  const TemporaryFolder folder;
  std::string bytes = *encodeImage(noise(CV_8UC1), {true, 92, 3});
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x55);
  EXPECT_THAT(readImage(folder.write("a.png", bytes), true).error().message,
              HasSubstr("a.png: the picture cannot be decoded"));
  EXPECT_THAT(readImage(folder.write("b.png", "GIF89a"), true).error().message,
              HasSubstr("neither a PNG nor a JPEG"));
  EXPECT_THAT(readImage(folder.write("c.png", ""), true).error().message, HasSubstr("is empty"));
  EXPECT_THAT(readImage(folder.path("d.png"), true).error().message, HasSubstr("cannot open"));
}

TEST(ImageFile, LeavesNothingBehindWhereItCannotWrite) {
  const auto status = writeImage("/nowhere/a.png", noise(CV_8UC1), {});
  ASSERT_FALSE(status.ok());
  EXPECT_THAT(status.error().message, HasSubstr("/nowhere/a.png: cannot write"));
}

}  // namespace
}  // namespace parkade
