// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace parkade {

/// Text for between the tags, or within the quotes, of XML and HTML. Control characters, which XML
/// does not allow, become blanks.
std::string escapedMarkup(std::string_view text);

}  // namespace parkade
