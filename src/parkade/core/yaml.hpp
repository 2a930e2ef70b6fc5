// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <yaml-cpp/node/node.h>

#include <Eigen/Core>
#include <functional>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <vector>

#include "parkade/core/result.hpp"

namespace parkade {

/// Thrown inside a reader by YamlNode; parseYamlFile turns it into an Error at the room's border.
class YamlError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A node of a YAML file that knows where it is: every failure names file, line, key and value.
class YamlNode {
 public:
  YamlNode(YAML::Node node, std::string file, std::string path);

  [[nodiscard]] bool has(const std::string& key) const;
  [[nodiscard]] YamlNode at(const std::string& key) const;  ///< throws where the key is missing
  [[nodiscard]] YamlNode at(std::size_t index) const;
  [[nodiscard]] std::size_t size() const;  ///< of a sequence or map
  [[nodiscard]] bool isMap() const;
  [[nodiscard]] bool isSequence() const;
  [[nodiscard]] std::vector<std::string> keys() const;  ///< of a map, in file order

  [[nodiscard]] double asDouble() const;  ///< finite, or throws
  [[nodiscard]] int asInt() const;
  [[nodiscard]] bool asBool() const;
  [[nodiscard]] std::string asString() const;
  /// Numbers of a flat or nested sequence, row by row.
  [[nodiscard]] std::vector<double> asDoubles() const;
  [[nodiscard]] Eigen::VectorXd asVector(int size) const;
  /// 4x4 homogeneous matrix as nested rows, flat 16, or {rows, cols, data}.
  [[nodiscard]] Eigen::Matrix4d asMatrix4() const;

  /// Throws where the map holds a key that is not listed; the message names it and the known ones.
  void allowOnly(std::initializer_list<const char*> known) const;

  /// Throws YamlError "file:line: path: message".
  [[noreturn]] void fail(const std::string& message) const;

  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] const YAML::Node& raw() const { return node_; }

 private:
  YAML::Node node_;
  std::string file_;
  std::string path_;
};

/// Reads a YAML file (an OpenCV "%YAML:1.0" heading is accepted) and hands its root to the reader.
/// Missing file, bad syntax and every YamlError come back as an Error.
template <class T>
Result<T> parseYamlFile(const std::string& path, const std::function<T(const YamlNode&)>& reader);

/// The root node itself, or an Error.
Result<YamlNode> openYaml(const std::string& path);
/// The same for a text; path is what messages call it.
Result<YamlNode> openYamlText(std::string text, const std::string& path);

template <class T>
Result<T> parseYamlFile(const std::string& path, const std::function<T(const YamlNode&)>& reader) {
  Result<YamlNode> root = openYaml(path);
  if (!root) return root.error();
  try {
    return reader(*root);
  } catch (const YamlError& error) {
    return Error{error.what()};
  }
}

}  // namespace parkade
