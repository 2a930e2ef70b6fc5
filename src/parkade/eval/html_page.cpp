// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/html_page.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>

#include "parkade/core/markup.hpp"

namespace parkade {
namespace {

constexpr const char* kPageStyle =
    "body{margin:0;background:#f4f5f7;color:#1c2430;font:16px/1.5 system-ui,'DejaVu Sans',"
    "Verdana,sans-serif}\n"
    "main{max-width:1240px;margin:0 auto;padding:12px}\n"
    "h1{font-size:1.6em;margin:.5em 0 .2em}h2{font-size:1.25em;margin:1.4em 0 .4em}\n"
    "h3{font-size:1em;margin:.2em 0 .5em}p{margin:.4em 0}\n"
    ".card,figure{background:#fff;border:1px solid #dde1e7;border-radius:8px;padding:10px;"
    "margin:0 0 12px;min-width:0}\n"
    ".figures{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,440px),1fr));"
    "gap:12px;margin:0 0 12px;align-items:start}.figures figure{margin:0}\n"
    ".small{grid-template-columns:repeat(auto-fit,minmax(min(100%,220px),1fr))}\n"
    "figure img{display:block;width:100%;height:auto}\n"
    "figcaption{font-size:.875em;color:#4a5563;margin-top:6px;overflow-wrap:anywhere}\n"
    ".legend{display:block;margin-top:4px}.legend span{display:inline-block;margin-right:12px}\n"
    ".legend i{display:inline-block;width:.8em;height:.8em;margin-right:5px;border:1px solid "
    "#8a8a8a}\n"
    ".scroll{overflow-x:auto}\n"
    "table{border-collapse:collapse;font-size:.875em;font-variant-numeric:tabular-nums}\n"
    "th,td{padding:4px 10px;border-bottom:1px solid #e6e9ee;text-align:right;white-space:nowrap}\n"
    "th{border-bottom:2px solid #aab3c0}th:first-child,td:first-child{text-align:left;"
    "position:sticky;left:0;background:#fff}\n"
    ".failed{color:#b3261e;white-space:normal;min-width:12em}.note{font-size:.875em;color:#4a5563}"
    "\n"
    "summary{cursor:pointer;font-weight:600}\n"
    "@media(max-width:600px){th,td{padding:4px 6px}"
    "th:first-child,td:first-child{white-space:normal;max-width:7.5em}}\n";

}  // namespace

std::string base64(std::string_view bytes) {
  constexpr std::string_view kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group <<= 8U;
      if (k < count) group |= static_cast<unsigned char>(bytes[i + k]);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= count ? kLetters[(group >> (18U - 6U * k)) & 63U] : '=';
    }
  }
  return text;
}

std::string dataUri(std::string_view type, std::string_view bytes) {
  return fmt::format("data:{};base64,{}", type, base64(bytes));
}

HtmlPage::HtmlPage(std::string_view title)
    : body_(fmt::format(
          "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
          // An empty picture, or the browser asks for one.
          "<link rel=\"icon\" href=\"data:,\">\n"
          "<title>{0}</title>\n<style>\n{1}</style>\n</head>\n<body>\n<main>\n<h1>{0}</h1>\n",
          escapedMarkup(title), kPageStyle)) {}

void HtmlPage::section(std::string_view title) {
  body_ += fmt::format("<h2>{}</h2>\n", escapedMarkup(title));
}

void HtmlPage::subsection(std::string_view title) {
  body_ += fmt::format("<h3>{}</h3>\n", escapedMarkup(title));
}

void HtmlPage::paragraph(std::string_view text) {
  body_ += fmt::format("<p>{}</p>\n", escapedMarkup(text));
}

void HtmlPage::tableBody(const TextTable& table) {
  body_ += "<div class=\"scroll\"><table>\n<thead><tr>";
  for (const std::string& one : table.header) {
    body_ += fmt::format("<th>{}</th>", escapedMarkup(one));
  }
  body_ += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    body_ += "<tr>";
    for (std::size_t i = 0; i < std::max(row.size(), table.header.size()); ++i) {
      const std::string text = i < row.size() ? row[i] : "";
      body_ += fmt::format("<td{}>{}</td>", text.starts_with("failed") ? " class=\"failed\"" : "",
                           escapedMarkup(text));
    }
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table></div>\n";
  if (!table.note.empty()) {
    body_ += fmt::format("<p class=\"note\">{}</p>\n", escapedMarkup(table.note));
  }
}

void HtmlPage::table(const TextTable& table) {
  body_ += fmt::format("<div class=\"card\"><h3>{}</h3>\n", escapedMarkup(table.title));
  tableBody(table);
  body_ += "</div>\n";
}

void HtmlPage::foldedTable(const TextTable& table) {
  body_ +=
      fmt::format("<details class=\"card\"><summary>{}</summary>\n", escapedMarkup(table.title));
  tableBody(table);
  body_ += "</details>\n";
}

void HtmlPage::beginFigures(bool small) {
  body_ += small ? "<div class=\"figures small\">\n" : "<div class=\"figures\">\n";
}

void HtmlPage::endFigures() {
  body_ += "</div>\n";
}

void HtmlPage::figure(const std::string& address, std::string_view caption,
                      const std::vector<LegendEntry>& legend) {
  std::string colours;
  for (const LegendEntry& entry : legend) {
    colours += fmt::format("<span><i style=\"background:{}\"></i>{}</span>",
                           escapedMarkup(entry.colour), escapedMarkup(entry.name));
  }
  if (!colours.empty()) colours = "<span class=\"legend\">" + colours + "</span>";
  body_ +=
      fmt::format("<figure><img alt=\"{0}\" src=\"{1}\"><figcaption>{0}{2}</figcaption></figure>\n",
                  escapedMarkup(caption), address, colours);
}

void HtmlPage::svg(std::string_view document, std::string_view caption,
                   const std::vector<LegendEntry>& legend) {
  figure(dataUri("image/svg+xml", document), caption, legend);
}

void HtmlPage::picture(std::string_view bytes, std::string_view caption,
                       const std::vector<LegendEntry>& legend) {
  const bool png = bytes.starts_with("\x89PNG");
  figure(dataUri(png ? "image/png" : "image/jpeg", bytes), caption, legend);
}

std::string HtmlPage::str() const {
  return body_ + "</main>\n</body>\n</html>\n";
}

}  // namespace parkade
