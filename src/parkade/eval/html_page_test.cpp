// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/html_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace parkade {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(HtmlPage, Base64OfTheStandard) {  // RFC 4648, section 10
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(HtmlPage, HoldsAllItsParts) {
  HtmlPage page("a < b");
  page.section("one & two");
  page.table({"T", "", {"x"}, {{"failed: <no>"}}});
  page.subsection("three");
  page.beginFigures(true);
  page.svg("<svg/>", "drawn");
  page.picture("\x89PNG...", "seen", {{"a & b", "#102030"}});
  page.endFigures();
  const std::string text = page.str();
  EXPECT_THAT(text, HasSubstr("<h1>a &lt; b</h1>"));
  EXPECT_THAT(text, HasSubstr("<h2>one &amp; two</h2>"));
  EXPECT_THAT(text, HasSubstr("<h3>three</h3>"));
  EXPECT_THAT(text, HasSubstr("<div class=\"figures small\">"));
  EXPECT_THAT(text, HasSubstr("<td class=\"failed\">failed: &lt;no&gt;</td>"));
  EXPECT_THAT(text, HasSubstr("data:image/svg+xml;base64,PHN2Zy8+"));
  EXPECT_THAT(text, HasSubstr("data:image/png;base64,"));
  EXPECT_THAT(text,
              HasSubstr("seen<span class=\"legend\"><span><i style=\"background:#102030\"></i>"
                        "a &amp; b</span></span></figcaption>"));
  EXPECT_THAT(text, HasSubstr("drawn</figcaption>"));
  EXPECT_THAT(text, Not(HasSubstr("http")));
  EXPECT_THAT(text, Not(HasSubstr("<script")));
}

}  // namespace
}  // namespace parkade
