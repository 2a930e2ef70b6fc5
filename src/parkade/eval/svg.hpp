// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace parkade::svg {

using Points = std::vector<Eigen::Vector2d>;

/// A picture as SVG text, in pixels, x to the right and y downwards. Elements name a class of the
/// style sheet given at the start.
class Document {
 public:
  Document(double width, double height, std::string_view title, std::string_view style);

  void line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, std::string_view css_class);
  void polyline(const Points& points, std::string_view css_class);
  void rectangle(const Eigen::Vector2d& corner, const Eigen::Vector2d& size,
                 std::string_view css_class);
  void circle(const Eigen::Vector2d& centre, double radius, std::string_view css_class);
  /// An oblique cross.
  void cross(const Eigen::Vector2d& centre, double radius, std::string_view css_class);
  /// Text is escaped; the class sets its anchor. Turned a quarter to the left where upright is not.
  void text(const Eigen::Vector2d& position, std::string_view text, std::string_view css_class,
            bool vertical = false);
  /// A picture given as an address, such as a data: URI; it fills the rectangle.
  void image(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, std::string_view address);
  /// What follows is hidden outside the rectangle, until endClip().
  void beginClip(const Eigen::Vector2d& corner, const Eigen::Vector2d& size);
  void endClip();

  /// The finished document.
  [[nodiscard]] std::string str() const { return body_ + "</svg>\n"; }

 private:
  std::string body_;
  int clips_ = 0;
};

/// One axis: data from low to high on pixels from low_px to high_px.
struct Axis {
  double low = 0.0;
  double high = 1.0;
  double low_px = 0.0;
  double high_px = 1.0;

  [[nodiscard]] double pixel(double value) const {
    return low_px + (value - low) / (high - low) * (high_px - low_px);
  }
};

/// Round numbers (1, 2 or 5 times a power of ten apart) in [low, high], about so many.
struct Ticks {
  std::vector<double> values;
  int decimals = 0;  ///< that all of them need
};
Ticks ticks(double low, double high, int about);

/// The least round number that is not below value > 0: an upper end for an axis that starts at 0.
double roundUp(double value);

/// A polyline with fewer points that stays within the tolerance (Douglas and Peucker 1973).
Points simplify(const Points& points, double tolerance);

/// A function of x with at most four points per pixel column, x ascending: first, lowest, highest,
/// last.
Points thinColumns(const Points& points);

/// At most max_characters, the middle replaced by an ellipsis.
std::string shorten(std::string_view text, std::size_t max_characters);

}  // namespace parkade::svg
