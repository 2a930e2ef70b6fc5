// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>

namespace parkade {

// What a study keeps of a drive, as it lies in memory: read back by the program that wrote it. Both
// have the same calls, so that one function tells what a type consists of; all return false where
// the file ends early or is none of these.

constexpr std::uint64_t kCacheTag = 0x706b636163686531;  // "pkcache1"

class CacheWriter {
 public:
  explicit CacheWriter(const std::string& path) : file_(path, std::ios::binary) {
    (*this)(kCacheTag);
  }

  template <class T>
  bool operator()(const T& value) {
    return static_cast<bool>(file_.write(reinterpret_cast<const char*>(&value), sizeof value));
  }
  /// A vector or a string of plain values.
  template <class Values>
  bool all(const Values& values) {
    return each(values, *this);
  }
  template <class Values, class Pass>
  bool each(Values& values, Pass&& pass) {
    if (!(*this)(values.size())) return false;
    for (auto& value : values) {
      if (!pass(value)) return false;
    }
    return true;
  }

  /// False where something could not be written.
  bool finish() { return static_cast<bool>(file_.flush()); }

 private:
  std::ofstream file_;
};

class CacheReader {
 public:
  explicit CacheReader(const std::string& path) : file_(path, std::ios::binary) {
    std::uint64_t tag = 0;
    if (!(*this)(tag) || tag != kCacheTag) file_.setstate(std::ios::failbit);
  }

  template <class T>
  bool operator()(T& value) {
    return static_cast<bool>(file_.read(reinterpret_cast<char*>(&value), sizeof value));
  }
  template <class Values>
  bool all(Values& values) {
    return each(values, *this);
  }
  template <class Values, class Pass>
  bool each(Values& values, Pass&& pass) {
    std::size_t count = 0;
    if (!(*this)(count)) return false;
    values.resize(count);
    for (auto& value : values) {
      if (!pass(value)) return false;
    }
    return true;
  }

 private:
  std::ifstream file_;
};

}  // namespace parkade
