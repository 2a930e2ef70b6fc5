// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

namespace parkade {

/// Something seen that may be of a track, and how badly the two fit.
struct TrackPair {
  double distance = 0.0;
  std::size_t track = 0;
  std::size_t seen = 0;
};

/// The track that each thing seen is of, at most one of each, the nearest pairs first (of those
/// alike, in their order); none where it is of none.
inline std::vector<std::optional<std::size_t>> matchNearestFirst(std::vector<TrackPair> pairs,
                                                                 std::size_t tracks,
                                                                 std::size_t seen) {
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const TrackPair& a, const TrackPair& b) { return a.distance < b.distance; });
  std::vector<bool> is_used(tracks, false);
  std::vector<std::optional<std::size_t>> matches(seen);
  for (const TrackPair& pair : pairs) {
    if (is_used[pair.track] || matches[pair.seen]) continue;
    is_used[pair.track] = true;
    matches[pair.seen] = pair.track;
  }
  return matches;
}

}  // namespace parkade
