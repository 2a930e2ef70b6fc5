// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace parkade {

/// A JSON document (of nlohmann's) as a file's text. Paths and names of the user's need not be
/// UTF-8: what is not becomes U+FFFD instead of an exception.
template <class Json>
std::string jsonText(const Json& json, int indent = 2) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace parkade
