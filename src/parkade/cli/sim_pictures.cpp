// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/sim_pictures.hpp"

#include <fmt/core.h>

#include <array>
#include <opencv2/core.hpp>

#include "parkade/io/file.hpp"
#include "parkade/io/image_file.hpp"
#include "parkade/sim/drive/frame_renderer.hpp"
#include "parkade/sim/drive/preview.hpp"
#include "parkade/sim/world/plan_image.hpp"
#include "parkade/types/semantic_class.hpp"

namespace parkade::cli {
namespace {

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

Status writePicture(const std::string& path, const cv::Mat& image) {
  ImageEncoding encoding;
  encoding.png = endsWith(path, ".png");
  constexpr int kQuality = 85;  // a few hundred kB for all pictures of the documents
  encoding.jpeg_quality = kQuality;
  return writeImage(path, image, encoding);
}

cv::Mat colouredLabels(const cv::Mat& labels) {
  std::array<cv::Vec3b, kNumSemanticClasses> colours;
  for (int i = 0; i < kNumSemanticClasses; ++i) {
    const cv::Scalar colour = sim::classColour(static_cast<SemanticClass>(i));
    for (int k = 0; k < 3; ++k) {
      colours[static_cast<std::size_t>(i)][k] = static_cast<std::uint8_t>(colour[k]);
    }
  }
  cv::Mat coloured(labels.size(), CV_8UC3, cv::Scalar::all(0));
  for (int y = 0; y < labels.rows; ++y) {
    for (int x = 0; x < labels.cols; ++x) {
      const std::size_t label = labels.at<std::uint8_t>(y, x);
      if (label < colours.size()) coloured.at<cv::Vec3b>(y, x) = colours[label];
    }
  }
  return coloured;
}

}  // namespace

Status writePlan(const sim::Simulation& simulation, const std::string& path) {
  return writePicture(path, sim::drawRoute(simulation));
}

Status writePictures(std::shared_ptr<const sim::Simulation> simulation, const std::string& folder) {
  const Status made = makeFolders(folder);
  if (!made) return made;
  const Result<std::unique_ptr<sim::FrameRenderer>> renderer = sim::FrameRenderer::make(simulation);
  if (!renderer) return renderer.error();
  const int index = static_cast<int>(simulation->frameTimes().size()) / 2;
  const FrameSet set = (*renderer)->draw(index);
  Status status;
  const auto write = [&status, &folder](const std::string& name, const cv::Mat& image) {
    if (status) status = writePicture(joinPath(folder, name), image);
  };
  for (std::size_t i = 0; i < set.images.size(); ++i) {
    const std::string& camera = simulation->trueRig().cameras[i].name;
    write(fmt::format("{}.jpg", camera), set.images[i]);
  }
  constexpr int kGroundPx = 640;
  constexpr double kMetresPerPx = 0.025;
  const sim::OrthoImages ground = (*renderer)->groundView(index, kGroundPx, kMetresPerPx);
  write("ground.jpg", ground.colour);
  write("ground_labels.png", colouredLabels(ground.labels));
  write("labels_front.png", colouredLabels((*renderer)->labels(index, 0)));
  constexpr int kOverviewPx = 1200;
  write("garage.jpg", (*renderer)->overview(kOverviewPx));
  write("plan.jpg", sim::drawRoute(*simulation));
  return status;
}

}  // namespace parkade::cli
