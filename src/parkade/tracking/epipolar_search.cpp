// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/tracking/epipolar_search.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "parkade/tracking/grid_sampling.hpp"

namespace parkade {
namespace {

constexpr int kRadius = 4;  // of the search pattern, in pixels of the coarse image
constexpr int kSide = 2 * kRadius + 1;
constexpr int kPixels = kSide * kSide;
constexpr int kNodes = 33;            // inverse depths at which the curve is projected exactly
constexpr double kStepPx = 1.5;       // px of the fine image between places along the curve
constexpr double kApartPx = 5.0;      // places farther apart than this compete
constexpr double kKnownRange = 0.25;  // share of a known inverse depth that is searched around it
constexpr double kMaxStretch = 3.0;   // warps beyond this hold too few pixels to compare
constexpr int kMaxPlaces = 600;

using Pattern = Eigen::Matrix<float, kPixels, 1>;

// Zero mean, unit norm; false where the pattern is flat.
bool normalise(Pattern& pattern) {
  pattern.array() -= pattern.mean();
  const float square = pattern.squaredNorm();
  if (square < 4.0F * kPixels) return false;
  pattern *= 1.0F / std::sqrt(square);
  return true;
}

// A place on the curve where the depth is known exactly.
struct Node {
  bool valid = false;
  double inverse_depth = 0.0;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Matrix2d warp = Eigen::Matrix2d::Identity();  // offsets in a to offsets in b
};

// The feature and two neighbours of it, as rays of a: a small plane across the ray.
struct PatchRays {
  Eigen::Vector3d centre;
  Eigen::Vector3d right;
  Eigen::Vector3d below;
};

constexpr double kNeighbourPx = 4.0;

std::optional<PatchRays> raysAround(const Camera& camera, const Eigen::Vector2d& pixel) {
  PatchRays rays;
  if (!camera.unproject(pixel, rays.centre) ||
      !camera.unproject(pixel + Eigen::Vector2d(kNeighbourPx, 0.0), rays.right) ||
      !camera.unproject(pixel + Eigen::Vector2d(0.0, kNeighbourPx), rays.below)) {
    return std::nullopt;
  }
  return rays;
}

Node projectNode(const Camera& b, const RowPair& pair, const PatchRays& rays,
                 double inverse_depth) {
  Node node;
  node.inverse_depth = inverse_depth;
  SE3 T_b_a = pair.atOnce();
  if (pair.rolling()) {
    // Which row it is read with follows from where it shows, and the other way round; once is
    // enough for a car that moves by far less than the distance to the point.
    Eigen::Vector2d about;
    if (!b.project(T_b_a.rotation() * rays.centre + inverse_depth * T_b_a.translation(), about)) {
      return node;
    }
    T_b_a = pair.at(about.y());
  }
  const Eigen::Vector3d shift = inverse_depth * T_b_a.translation();
  Eigen::Vector2d right;
  Eigen::Vector2d below;
  if (!b.project(T_b_a.rotation() * rays.centre + shift, node.pixel) || !b.inImage(node.pixel) ||
      !b.project(T_b_a.rotation() * rays.right + shift, right) ||
      !b.project(T_b_a.rotation() * rays.below + shift, below)) {
    return node;
  }
  node.warp.col(0) = (right - node.pixel) / kNeighbourPx;
  node.warp.col(1) = (below - node.pixel) / kNeighbourPx;
  const double area = std::abs(node.warp.determinant());
  node.valid = node.warp.norm() < kMaxStretch && area > 1.0 / (kMaxStretch * kMaxStretch);
  return node;
}

struct Place {
  double correlation = -1.0;
  double inverse_depth = 0.0;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Matrix2d warp = Eigen::Matrix2d::Identity();
};

// Correlation at one place of b.
double correlate(const SearchImage& b, const Pattern& wanted, const Eigen::Vector2d& pixel,
                 const Eigen::Matrix2d& warp) {
  Pattern seen;
  // Pixel centres: coarse = fine / 2 for an image decimated at even pixels (cv::pyrDown).
  if (!sampleGrid(b.coarse, 0.5 * pixel, warp, kRadius, seen.data()) || !normalise(seen)) {
    return -1.0;
  }
  return wanted.dot(seen);
}

std::vector<Place> walkCurve(const SearchImage& b, const RowPair& pair, const PatchRays& rays,
                             const Pattern& wanted, double from, double to) {
  std::vector<Place> places;
  Node last;
  for (int i = 0; i < kNodes; ++i) {
    const double share = static_cast<double>(i) / (kNodes - 1);
    const Node node = projectNode(*b.camera, pair, rays, from + share * (to - from));
    if (node.valid) {
      int steps = 1;
      if (last.valid) {
        steps =
            std::max(1, static_cast<int>(std::ceil((node.pixel - last.pixel).norm() / kStepPx)));
      }
      // A short move waits for the next node, so that places do not crowd where depth says little.
      if (last.valid && (node.pixel - last.pixel).norm() < 0.5 * kStepPx && i + 1 < kNodes)
        continue;
      for (int s = 1; s <= steps && static_cast<int>(places.size()) < kMaxPlaces; ++s) {
        const double ratio = last.valid ? static_cast<double>(s) / steps : 1.0;
        Place place;
        place.inverse_depth =
            last.valid ? last.inverse_depth + ratio * (node.inverse_depth - last.inverse_depth)
                       : node.inverse_depth;
        place.pixel = last.valid ? Eigen::Vector2d(last.pixel + ratio * (node.pixel - last.pixel))
                                 : node.pixel;
        place.warp = node.warp;
        place.correlation = correlate(b, wanted, place.pixel, place.warp);
        places.push_back(place);
      }
    }
    last = node;
  }
  return places;
}

// The best place, if no other one comes near.
std::optional<Place> pickUnique(const std::vector<Place>& places, const MatchingOptions& options) {
  const auto best = std::max_element(
      places.begin(), places.end(),
      [](const Place& x, const Place& y) { return x.correlation < y.correlation; });
  if (best == places.end() || best->correlation < options.min_search_correlation) {
    return std::nullopt;
  }
  for (const Place& place : places) {
    if ((place.pixel - best->pixel).norm() > kApartPx &&
        place.correlation > best->correlation - options.uniqueness) {
      return std::nullopt;
    }
  }
  return *best;
}

}  // namespace

EpipolarCheck checkEpipolar(const Eigen::Vector3d& ray_a, const Eigen::Vector3d& ray_b,
                            const SE3& T_b_a, double focal_px) {
  EpipolarCheck check;
  const Eigen::Vector3d a = T_b_a.rotation() * ray_a;
  const Eigen::Vector3d& t = T_b_a.translation();
  const Eigen::Vector3d normal = t.cross(a);
  const double length = normal.norm();
  check.distance_px =
      focal_px * (length > 1e-9 ? std::abs(ray_b.dot(normal)) / length : (ray_b - a).norm());
  // s_b ray_b = s_a a + t; crossing with ray_b and with a gives each length.
  const Eigen::Vector3d cross = a.cross(ray_b);
  const Eigen::Vector3d from_b = ray_b.cross(t);  // s_a (a x ray_b) = ray_b x t
  const Eigen::Vector3d from_a = a.cross(t);      // s_b (a x ray_b) = a x t
  const double square_b = from_b.squaredNorm();
  const double square_a = from_a.squaredNorm();
  check.inverse_depth_a = square_b > 1e-18 ? cross.dot(from_b) / square_b : 0.0;
  check.inverse_depth_b = square_a > 1e-18 ? cross.dot(from_a) / square_a : 0.0;
  return check;
}

std::optional<CrossMatch> searchEpipolar(const SearchImage& a, const SearchImage& b,
                                         const RowPair& pair, const Eigen::Vector2d& pixel_a,
                                         const Eigen::Matrix2d& warp_a, const Patch& patch,
                                         double known_depth, const MatchingOptions& options) {
  const std::optional<PatchRays> rays = raysAround(*a.camera, pixel_a);
  Pattern wanted;
  if (!rays ||
      !sampleGrid(a.coarse, 0.5 * pixel_a, Eigen::Matrix2d::Identity(), kRadius, wanted.data()) ||
      !normalise(wanted)) {
    return std::nullopt;
  }
  double from = 1.0 / options.min_depth_m;
  double to = 0.0;
  if (known_depth > 0.0) {
    from = std::min(from, (1.0 + kKnownRange) / known_depth);
    to = (1.0 - kKnownRange) / known_depth;
  }
  const std::optional<Place> place =
      pickUnique(walkCurve(b, pair, *rays, wanted, from, to), options);
  if (!place) return std::nullopt;
  CrossMatch match;
  // The shape is known from geometry but for the slant of the surface: leave it some freedom.
  constexpr double kSlant = 0.1;
  match.alignment = patch.align(b.fine, place->pixel, place->warp * warp_a, kSlant, 15);
  const PatchAlignment& found = match.alignment;
  if (!found.converged || found.correlation < options.min_correlation ||
      (found.pixel - place->pixel).norm() > 2.0 * kStepPx) {
    return std::nullopt;
  }
  Eigen::Vector3d ray_b;
  if (!b.camera->unproject(found.pixel, ray_b)) return std::nullopt;
  const double focal = b.camera->focalLength();
  const SE3 T_b_a = pair.at(found.pixel.y());
  const EpipolarCheck check = checkEpipolar(rays->centre, ray_b, T_b_a, focal);
  match.epipolar_px = check.distance_px;
  match.inverse_depth = std::max(0.0, check.inverse_depth_a);
  // A far point may come out just behind the camera through noise: as far as a pixel explains.
  const double baseline = std::max(T_b_a.translation().norm(), 1e-6);
  const double least = -options.max_epipolar_px / (focal * baseline);
  if (check.distance_px > options.max_epipolar_px || check.inverse_depth_a < least ||
      check.inverse_depth_b < least || check.inverse_depth_a > 1.0 / options.min_depth_m) {
    return std::nullopt;
  }
  return match;
}

}  // namespace parkade
