// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace parkade {

/// A table of texts, for a terminal, a Markdown file and a page.
struct TextTable {
  std::string title;
  std::string note;  ///< under the table; may be empty
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;  ///< as wide as the header, or shorter
};

/// Columns aligned, the first to the left, the others to the right; ended by a newline.
std::string plainText(const TextTable& table);

/// GitHub's Markdown: a heading of the third level, the table, the note; ended by a newline.
std::string markdown(const TextTable& table);

/// Characters, not bytes, of UTF-8 text.
std::size_t displayWidth(const std::string& text);

}  // namespace parkade
