// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/palette.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "parkade/core/random.hpp"
#include "parkade/sim/world/polygon.hpp"
#include "parkade/sim/world/stroke_font.hpp"

namespace parkade::sim {
namespace {

std::uint8_t srgbByte(float linear) {
  const float v = std::clamp(linear, 0.0F, 1.0F);
  const float s = v <= 0.0031308F ? 12.92F * v : 1.055F * std::pow(v, 1.0F / 2.4F) - 0.055F;
  return static_cast<std::uint8_t>(std::lround(255.0F * s));
}

cv::Scalar srgb(const Eigen::Vector3f& linear) {
  return {static_cast<double>(srgbByte(linear.x())), static_cast<double>(srgbByte(linear.y())),
          static_cast<double>(srgbByte(linear.z()))};
}

/// Plates are drawn with y up in metres from their middle; row 0 of a texture is its lower edge.
class Plate {
 public:
  Plate(double width, double height, double px_per_metre, const Eigen::Vector3f& back)
      : scale_(px_per_metre) {
    const int columns = std::max(8, static_cast<int>(std::lround(width * scale_)));
    const int rows = std::max(8, static_cast<int>(std::lround(height * scale_)));
    image_ = cv::Mat(rows, columns, CV_8UC3, srgb(back));
    center_ = {0.5 * columns, 0.5 * rows};
  }

  void fill(const Polygon& polygon, const Eigen::Vector3f& colour) {
    std::vector<cv::Point> points;
    for (const Eigen::Vector2d& p : polygon) points.push_back(pixel(p));
    cv::fillPoly(image_, std::vector<std::vector<cv::Point>>{points}, srgb(colour), cv::LINE_AA,
                 kShift);
  }

  void disc(const Eigen::Vector2d& center, double radius, const Eigen::Vector3f& colour) {
    cv::circle(image_, pixel(center), static_cast<int>(std::lround(radius * scale_ * 16.0)),
               srgb(colour), cv::FILLED, cv::LINE_AA, kShift);
  }

  void text(const std::string& text, const Eigen::Vector2d& center, double height, double weight,
            const Eigen::Vector3f& colour) {
    for (Polygon& polygon : textPolygons(text, height, weight)) {
      for (Eigen::Vector2d& p : polygon) p += center - Eigen::Vector2d(0.0, 0.5 * height);
      fill(polygon, colour);
    }
  }

  [[nodiscard]] Texture texture() const {
    Texture out;
    out.width = image_.cols;
    out.height = image_.rows;
    out.rgb.assign(image_.datastart, image_.dataend);
    return out;
  }

 private:
  static constexpr int kShift = 4;
  [[nodiscard]] cv::Point pixel(const Eigen::Vector2d& p) const {
    // Half a pixel back: OpenCV's pixel centres lie at integers.
    const Eigen::Vector2d q = (p * scale_ + center_).array() - 0.5;
    return {static_cast<int>(std::lround(q.x() * 16.0)),
            static_cast<int>(std::lround(q.y() * 16.0))};
  }

  double scale_;
  cv::Mat image_;
  Eigen::Vector2d center_;
};

/// Smooth noise, 0 to 1, that repeats after `period` cells.
float valueNoise(float x, float y, int period, std::uint64_t seed) {
  const auto at = [&](int i, int j) {
    const auto wrap = [&](int k) {
      return static_cast<std::uint64_t>((k % period + period) % period);
    };
    return static_cast<float>(hash64(seed, wrap(i) * 65536U + wrap(j)) >> 40) / 16777216.0F;
  };
  const int i = static_cast<int>(std::floor(x));
  const int j = static_cast<int>(std::floor(y));
  const auto ease = [](float t) { return t * t * (3.0F - 2.0F * t); };
  const float u = ease(x - static_cast<float>(i));
  const float v = ease(y - static_cast<float>(j));
  return (1 - v) * ((1 - u) * at(i, j) + u * at(i + 1, j)) +
         v * ((1 - u) * at(i, j + 1) + u * at(i + 1, j + 1));
}

Polygon arrowHead(const Eigen::Vector2d& center, double size, const std::string& meaning) {
  // Pointing up, turned to the sign's direction.
  Polygon arrow = {{-0.10, -0.5}, {0.10, -0.5},  {0.10, 0.02}, {0.34, 0.02},
                   {0.0, 0.5},    {-0.34, 0.02}, {-0.10, 0.02}};
  const double turn = meaning.find("left") != std::string::npos    ? M_PI_2
                      : meaning.find("right") != std::string::npos ? -M_PI_2
                                                                   : 0.0;
  for (Eigen::Vector2d& p : arrow) p *= size;
  return moved({center, turn}, arrow);
}

}  // namespace

std::uint16_t Palette::add(const std::string& name, SemanticClass label,
                           const Eigen::Vector3f& albedo, float roughness, float specular,
                           int texture) {
  Material material;
  material.name = name;
  material.label = label;
  material.albedo = albedo;
  material.roughness = roughness;
  material.specular = specular;
  material.texture = texture;
  scene_.materials.push_back(material);
  return static_cast<std::uint16_t>(scene_.materials.size() - 1);
}

std::uint16_t Palette::addGlow(const std::string& name, SemanticClass label,
                               const Eigen::Vector3f& emission, int texture) {
  const std::uint16_t index =
      add(name, label, Eigen::Vector3f::Constant(0.5F), 0.6F, 0.04F, texture);
  scene_.materials[index].emission = emission;
  return index;
}

int Palette::addTexture(Texture texture) {
  scene_.textures.push_back(std::move(texture));
  return static_cast<int>(scene_.textures.size()) - 1;
}

Texture stainTexture(int size, double contrast, std::uint64_t seed) {
  Texture texture;
  texture.width = texture.height = size;
  texture.rgb.resize(3U * static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  const auto strength = static_cast<float>(contrast);
  std::size_t k = 0;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const float u = static_cast<float>(x) / static_cast<float>(size);
      const float v = static_cast<float>(y) / static_cast<float>(size);
      float value = 0.0F;
      float weight = 0.5F;
      for (int cells = 4; cells <= size / 2; cells *= 2) {
        value += weight * (valueNoise(u * cells, v * cells, cells, seed + cells) - 0.5F);
        weight *= 0.72F;
      }
      // Streaks of water run down, pores are dark specks.
      const float streak = valueNoise(u * 32.0F, v * 2.0F, 32, seed + 7);
      value -= 0.5F * std::max(streak - 0.72F, 0.0F);
      const float pore = valueNoise(u * size / 3.0F, v * size / 3.0F, size / 3, seed + 9);
      value -= 0.8F * std::max(pore - 0.88F, 0.0F) * 4.0F;
      const std::uint8_t byte = srgbByte(0.86F + strength * value);
      texture.rgb[k++] = byte;
      texture.rgb[k++] = byte;
      texture.rgb[k++] = byte;
    }
  }
  return texture;
}

Texture stripeTexture(int size) {
  Texture texture;
  texture.width = texture.height = size;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const bool yellow = (x + y) % size < size / 2;
      const Eigen::Vector3f colour =
          yellow ? Eigen::Vector3f(0.72F, 0.48F, 0.03F) : Eigen::Vector3f::Constant(0.025F);
      for (int c = 0; c < 3; ++c) texture.rgb.push_back(srgbByte(colour[c]));
    }
  }
  return texture;
}

Texture plateTexture(double width, double height, const std::string& text, double text_height,
                     const PlateStyle& style, double px_per_metre, const Eigen::Vector2d& off) {
  Plate plate(width, height, px_per_metre, style.back);
  plate.text(text, off, text_height, style.weight, style.ink);
  return plate.texture();
}

Texture guideTexture(double width, double height, const std::string& meaning) {
  const bool exit = meaning.rfind("exit", 0) == 0 || meaning == "EXIT";
  const bool parking = meaning.rfind("parking", 0) == 0;
  const Eigen::Vector3f back = exit      ? Eigen::Vector3f(0.01F, 0.22F, 0.07F)
                               : parking ? Eigen::Vector3f(0.01F, 0.07F, 0.36F)
                                         : Eigen::Vector3f(0.02F, 0.02F, 0.025F);
  const Eigen::Vector3f ink = Eigen::Vector3f::Constant(0.9F);
  Plate plate(width, height, 300.0, back);
  const std::string word = exit ? "EXIT" : parking ? "P" : "LIFT";
  const bool arrow = meaning.find('_') != std::string::npos;
  const double text_height = 0.58 * height;
  const bool at_left = meaning.find("left") != std::string::npos;
  const double shift = arrow ? (at_left ? 0.14 : -0.14) * width : 0.0;
  plate.text(word, {shift, 0.0}, text_height, 0.17, ink);
  if (arrow) {
    const double x = (at_left ? -0.34 : 0.34) * width;
    plate.fill(arrowHead({x, 0.0}, 0.62 * height, meaning), ink);
  }
  return plate.texture();
}

Texture limitTexture(const std::string& text, double weight) {
  Plate plate(1.0, 1.0, 192.0, Eigen::Vector3f::Constant(0.75F));
  plate.disc({0.0, 0.0}, 0.5, {0.55F, 0.02F, 0.02F});
  plate.disc({0.0, 0.0}, 0.39, Eigen::Vector3f::Constant(0.8F));
  const double full = textWidth(text, 0.42, weight);
  plate.text(text, {0.0, 0.0}, 0.42 * std::min(1.0, 0.64 / full), weight,
             Eigen::Vector3f::Constant(0.02F));
  return plate.texture();
}

Texture posterTexture(std::uint64_t seed) {
  Random random(seed);
  const auto colour = [&] {
    return Eigen::Vector3f(static_cast<float>(random.uniform(0.03, 0.8)),
                           static_cast<float>(random.uniform(0.03, 0.8)),
                           static_cast<float>(random.uniform(0.03, 0.8)));
  };
  Plate plate(0.8, 1.1, 220.0, colour());
  for (int i = 0; i < 5; ++i) {
    const double x = random.uniform(-0.3, 0.2);
    const double y = random.uniform(-0.45, 0.35);
    plate.fill(rectangle({}, x, y, x + random.uniform(0.08, 0.3), y + random.uniform(0.05, 0.3)),
               colour());
  }
  plate.disc({random.uniform(-0.2, 0.2), random.uniform(-0.3, 0.3)}, random.uniform(0.06, 0.18),
             colour());
  constexpr std::array<const char*, 6> kWords = {"SAFETY", "CITY", "SLOW",
                                                 "NOTICE", "SALE", "CAFE"};
  const Eigen::Vector3f ink = random.chance(0.5) ? Eigen::Vector3f::Constant(0.9F).eval()
                                                 : Eigen::Vector3f::Constant(0.02F).eval();
  plate.text(random.pick(kWords), {0.0, 0.40}, 0.13, 0.16, ink);
  for (int i = 0; i < 4; ++i) {
    const double y = -0.28 - 0.06 * i;
    plate.fill(rectangle({}, -0.33, y, random.uniform(0.0, 0.33), y + 0.025), ink);
  }
  return plate.texture();
}

}  // namespace parkade::sim
