// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/text_table.hpp"

#include <algorithm>

namespace parkade {
namespace {

std::vector<std::string> filled(std::vector<std::string> row, std::size_t columns) {
  row.resize(std::max(columns, row.size()));
  return row;
}

std::vector<std::size_t> columnWidths(const TextTable& table) {
  std::vector<std::size_t> widths(table.header.size(), 0);
  const auto widen = [&widths](const std::vector<std::string>& row) {
    if (row.size() > widths.size()) widths.resize(row.size(), 0);
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], displayWidth(row[i]));
    }
  };
  widen(table.header);
  for (const auto& row : table.rows) widen(row);
  return widths;
}

std::string padded(const std::string& text, std::size_t width, bool to_the_left) {
  const std::string blanks(width - std::min(width, displayWidth(text)), ' ');
  return to_the_left ? text + blanks : blanks + text;
}

std::string line(const std::vector<std::string>& row, const std::vector<std::size_t>& widths) {
  std::string text;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (i > 0) text += "  ";
    text += padded(row[i], widths[i], i == 0);
  }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text + "\n";
}

// A bar would end the cell.
std::string cell(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '|') result += '\\';
    result += c == '\n' ? ' ' : c;
  }
  return result;
}

std::string markdownRow(const std::vector<std::string>& row) {
  std::string text = "|";
  for (const std::string& one : row) text += " " + cell(one) + " |";
  return text + "\n";
}

}  // namespace

std::size_t displayWidth(const std::string& text) {
  // Bytes 10xxxxxx continue a character.
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

std::string plainText(const TextTable& table) {
  const std::vector<std::size_t> widths = columnWidths(table);
  std::string text = table.title + "\n";
  text += line(filled(table.header, widths.size()), widths);
  std::size_t total = 0;
  for (const std::size_t width : widths) total += width + 2;
  text += std::string(total > 2 ? total - 2 : 0, '-') + "\n";
  for (const auto& row : table.rows) text += line(filled(row, widths.size()), widths);
  if (!table.note.empty()) text += table.note + "\n";
  return text;
}

std::string markdown(const TextTable& table) {
  const std::size_t columns = columnWidths(table).size();
  std::string text = "### " + table.title + "\n\n";
  text += markdownRow(filled(table.header, columns)) + "|---|";
  for (std::size_t i = 1; i < columns; ++i) text += "---:|";
  text += "\n";
  for (const auto& row : table.rows) text += markdownRow(filled(row, columns));
  if (!table.note.empty()) text += "\n" + table.note + "\n";
  return text;
}

}  // namespace parkade
