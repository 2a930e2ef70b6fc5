// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/core/random.hpp"

#include <cmath>
#include <numbers>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

std::uint64_t rotateLeft(std::uint64_t x, int k) {
  return (x << k) | (x >> (64 - k));
}

}  // namespace

Random::Random(std::uint64_t seed) : seed_(seed) {
  for (std::uint64_t i = 0; i < 4; ++i) state_[i] = hash64(seed, i);
}

Random Random::fork(std::string_view name, std::uint64_t index) const {
  std::uint64_t hash = 0xcbf29ce484222325ULL;  // FNV-1a
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return Random(hash64(hash64(seed_, hash), index));
}

std::uint64_t Random::bits() {
  const std::uint64_t result = rotateLeft(state_[0] + state_[3], 23) + state_[0];
  const std::uint64_t t = state_[1] << 17;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= t;
  state_[3] = rotateLeft(state_[3], 45);
  return result;
}

double Random::uniform() {
  return static_cast<double>(bits() >> 11) * 0x1.0p-53;
}

double Random::uniform(double low, double high) {
  return low + (high - low) * uniform();
}

int Random::integer(int low, int high) {
  PARKADE_CHECK(low <= high, "empty range {}..{}", low, high);
  return low + static_cast<int>(index(static_cast<std::size_t>(high - low) + 1));
}

bool Random::chance(double probability) {
  return uniform() < probability;
}

double Random::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  // Box-Muller; 1 - u keeps the logarithm's argument above zero.
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  const double angle = 2.0 * std::numbers::pi * uniform();
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

double Random::normal(double mean, double sigma) {
  return mean + sigma * normal();
}

std::size_t Random::index(std::size_t count) {
  PARKADE_CHECK(count > 0 && count < (1ULL << 32), "index of a range of {}", count);
  return static_cast<std::size_t>(((bits() >> 32) * count) >> 32);
}

}  // namespace parkade
