// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/texts/zone_marker_outline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "parkade/core/check.hpp"
#include "parkade/core/units.hpp"

namespace parkade {
namespace {

// 1 / depth along a line through the column x0, relative to that at x0: equation (2). The line runs
// along (cos angle, sin angle) in (right, ahead).
double relativeHeight(double x, double x0, double cosine, double sine) {
  return (cosine - x * sine) / (cosine - x0 * sine);
}

struct Fit {
  double cost = std::numeric_limits<double>::infinity();
  double x0 = 0.0;
  double height = 0.0;  // h at x0
  double left = 0.0;    // rad, of the lines left and right of x0
  double right = 0.0;
};

class OutlineFit {
 public:
  OutlineFit(const std::vector<MarkerColumn>& columns, double x_left, double x_right, double sigma)
      : columns_(columns), x_left_(x_left), x_right_(x_right), sigma_(sigma) {}

  // One face turned by each angle; pillars are not looked at along their faces by chance.
  [[nodiscard]] Fit single() const {
    constexpr double kPrior = 40.0 * kDegree;
    Fit best;
    const double x0 = 0.5 * (x_left_ + x_right_);
    for (int deg = -65; deg <= 65; deg += 5) {
      Fit fit;
      fit.x0 = x0;
      fit.left = fit.right = deg * kDegree;
      solve(fit);
      fit.cost += square(fit.left / kPrior);
      if (fit.cost < best.cost) best = fit;
    }
    return best;
  }

  // Two faces at right angles that meet at each column; a pillar's faces are about as wide.
  [[nodiscard]] Fit corner() const {
    constexpr double kWidthPrior = 0.25;  // of the logarithm of the widths' ratio
    constexpr int kSteps = 24;
    Fit best;
    for (int k = 1; k < kSteps; ++k) {
      for (int deg = 5; deg <= 85; deg += 5) {
        Fit fit;
        fit.x0 = x_left_ + (x_right_ - x_left_) * k / kSteps;
        fit.left = -deg * kDegree;  // nearer towards the edge
        fit.right = fit.left + 0.5 * M_PI;
        solve(fit);
        if (!std::isfinite(fit.cost)) continue;
        const std::vector<FittedFace> faces = facesOf(fit);
        fit.cost += square(std::log(faces[0].width() / faces[1].width()) / kWidthPrior);
        if (fit.cost < best.cost) best = fit;
      }
    }
    return best;
  }

  [[nodiscard]] std::vector<FittedFace> facesOf(const Fit& fit) const {
    const auto depth = [&](double x, double angle) {
      return 1.0 / (fit.height * relativeHeight(x, fit.x0, std::cos(angle), std::sin(angle)));
    };
    if (fit.left == fit.right) {
      return {{x_left_, x_right_, depth(x_left_, fit.left), depth(x_right_, fit.left)}};
    }
    return {{x_left_, fit.x0, depth(x_left_, fit.left), 1.0 / fit.height},
            {fit.x0, x_right_, 1.0 / fit.height, depth(x_right_, fit.right)}};
  }

 private:
  // Height at x0 by least squares, and what remains; infinite where a line does not reach.
  void solve(Fit& fit) const {
    const double cosines[2] = {std::cos(fit.left), std::cos(fit.right)};
    const double sines[2] = {std::sin(fit.left), std::sin(fit.right)};
    constexpr double kLeast = 0.2;
    if (relativeHeight(x_left_, fit.x0, cosines[0], sines[0]) < kLeast ||
        relativeHeight(x_right_, fit.x0, cosines[1], sines[1]) < kLeast) {
      return;
    }
    double gg = 0.0;
    double gh = 0.0;
    double hh = 0.0;
    for (const MarkerColumn& c : columns_) {
      const int side = c.x > fit.x0 ? 1 : 0;
      const double g = relativeHeight(c.x, fit.x0, cosines[side], sines[side]);
      const double h = c.top - c.bottom;
      gg += g * g;
      gh += g * h;
      hh += h * h;
    }
    fit.height = gh / gg;
    fit.cost = fit.height > 0.0 ? std::max(0.0, hh - gh * fit.height) / square(sigma_)
                                : std::numeric_limits<double>::infinity();
  }

  const std::vector<MarkerColumn>& columns_;
  double x_left_;
  double x_right_;
  double sigma_;
};

}  // namespace

double FittedFace::width() const {
  return std::hypot(x_right * depth_right - x_left * depth_left, depth_right - depth_left);
}

double FittedFace::slant() const {
  const Eigen::Vector2d left(x_left * depth_left, depth_left);
  const Eigen::Vector2d right(x_right * depth_right, depth_right);
  const Eigen::Vector2d middle = 0.5 * (left + right);
  const Eigen::Vector2d along = right - left;
  return std::asin(std::min(1.0, std::abs(along.dot(middle)) / (along.norm() * middle.norm())));
}

FittedMarker fitMarker(const std::vector<MarkerColumn>& columns, double x_left, double x_right,
                       double sigma, bool corners) {
  PARKADE_CHECK(!columns.empty() && x_left < x_right && sigma > 0.0, "no outline to fit");
  const OutlineFit fits(columns, x_left, x_right, sigma);
  Fit fit = fits.single();
  FittedMarker marker;
  constexpr double kCornerPrior = 2.0;  // two parameters more, and pillars mostly show two faces
  if (corners && columns.size() >= 4) {
    Fit corner = fits.corner();
    corner.cost += kCornerPrior;
    if (corner.cost < fit.cost) std::swap(fit, corner);
    if (std::isfinite(corner.cost)) marker.other_faces = fits.facesOf(corner);
  }
  marker.faces = fits.facesOf(fit);
  const double x = 0.5 * (x_left + x_right);
  const double angle = x > fit.x0 ? fit.right : fit.left;
  marker.height_at_middle =
      fit.height * relativeHeight(x, fit.x0, std::cos(angle), std::sin(angle));
  // The middle's height over the camera: mean of v h / h^2 over the columns.
  double vh = 0.0;
  double hh = 0.0;
  for (const MarkerColumn& c : columns) {
    const double a = c.x > fit.x0 ? fit.right : fit.left;
    const double h = fit.height * relativeHeight(c.x, fit.x0, std::cos(a), std::sin(a));
    vh += 0.5 * (c.top + c.bottom) * h;
    hh += h * h;
  }
  marker.middle = vh / hh;
  return marker;
}

}  // namespace parkade
