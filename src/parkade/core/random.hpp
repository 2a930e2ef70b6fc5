// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

namespace parkade {

/// Mixes two words into one (SplitMix64 finaliser): a counter-based random source.
constexpr std::uint64_t hash64(std::uint64_t a, std::uint64_t b = 0) {
  std::uint64_t z = a + 0x9e3779b97f4a7c15ULL * (b + 1);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/// A word's upper bits as a number in [0, 1).
constexpr float uniformOf(std::uint64_t bits) {
  return static_cast<float>(bits >> 40U) * (1.0F / 16777216.0F);
}

/// A seeded random source whose numbers are the same on every platform and in every build
/// (xoshiro256++; distributions of our own, because those of <random> differ between libraries).
class Random {
 public:
  explicit Random(std::uint64_t seed);

  /// An independent source for a part: the same (seed, name, index) gives the same numbers whatever
  /// else was drawn.
  [[nodiscard]] Random fork(std::string_view name, std::uint64_t index = 0) const;

  std::uint64_t bits();
  double uniform();                         ///< [0, 1)
  double uniform(double low, double high);  ///< [low, high)
  int integer(int low, int high);           ///< low..high, both included
  bool chance(double probability);
  double normal();  ///< mean 0, standard deviation 1
  double normal(double mean, double sigma);
  std::size_t index(std::size_t count);  ///< 0..count-1

  template <class Container>
  const auto& pick(const Container& container) {
    return container[index(container.size())];
  }
  template <class Container>
  void shuffle(Container& container) {
    for (std::size_t i = container.size(); i > 1; --i) {
      std::swap(container[i - 1], container[index(i)]);
    }
  }

 private:
  std::uint64_t seed_;
  std::uint64_t state_[4];
  bool has_spare_ = false;
  double spare_ = 0.0;
};

}  // namespace parkade
