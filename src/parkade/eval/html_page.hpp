// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "parkade/eval/text_table.hpp"

namespace parkade {

/// Base64 of RFC 4648.
std::string base64(std::string_view bytes);

/// The bytes as a data: URI; type as "image/png".
std::string dataUri(std::string_view type, std::string_view bytes);

/// What a colour of a picture stands for.
struct LegendEntry {
  std::string name;
  std::string colour;  ///< "#rrggbb"
};

/// One page that needs nothing but itself: no script, no network, all pictures within. Readable
/// from 390 pixels of width on: figures stand side by side where there is room, and wide tables
/// scroll.
class HtmlPage {
 public:
  explicit HtmlPage(std::string_view title);

  void section(std::string_view title);
  void subsection(std::string_view title);
  void paragraph(std::string_view text);
  void table(const TextTable& table);
  /// The same, folded up until it is clicked.
  void foldedTable(const TextTable& table);
  /// Figures between beginFigures() and endFigures() share rows of two; of more where small.
  void beginFigures(bool small = false);
  void endFigures();
  /// An SVG document (svg.hpp), as a picture of its own: its styles and ids stay within.
  void svg(std::string_view document, std::string_view caption,
           const std::vector<LegendEntry>& legend = {});
  /// A PNG or JPEG file's bytes.
  void picture(std::string_view bytes, std::string_view caption,
               const std::vector<LegendEntry>& legend = {});

  /// The finished page.
  [[nodiscard]] std::string str() const;

 private:
  void figure(const std::string& address, std::string_view caption,
              const std::vector<LegendEntry>& legend);
  void tableBody(const TextTable& table);
  std::string body_;
};

}  // namespace parkade
