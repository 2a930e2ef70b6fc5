// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/core/yaml.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <system_error>
#include <utility>

namespace parkade {
namespace {

// What the file says at a node, for messages; long values are cut.
std::string shown(const YAML::Node& node) {
  if (!node.IsDefined() || node.IsNull()) return "nothing";
  std::string text = node.IsScalar() ? node.Scalar() : YAML::Dump(node);
  std::replace(text.begin(), text.end(), '\n', ' ');
  constexpr std::size_t kMaxShown = 60;
  if (text.size() > kMaxShown) text = text.substr(0, kMaxShown) + "...";
  return "'" + text + "'";
}

constexpr int kMaxDepth = 32;
constexpr std::size_t kMaxNodes = 1'000'000;

// What yaml-cpp takes and nobody means: keys twice (it drops one of them), keys that are no text,
// and aliases of what they stand in or that multiply, which never end.
Status checkTree(const YAML::Node& node, const std::string& path, int depth, std::size_t& nodes) {
  const auto problem = [&](const YAML::Node& at, const std::string& what) {
    return Error{fmt::format("{}:{}: {}", path, at.Mark().line + 1, what)};
  };
  if (depth > kMaxDepth || ++nodes > kMaxNodes) {
    return problem(node, "nested too deeply, or an alias within itself; write the values out");
  }
  if (node.IsSequence()) {
    for (const auto& child : node) {
      if (Status status = checkTree(child, path, depth + 1, nodes); !status) return status;
    }
  }
  if (!node.IsMap()) return {};
  std::set<std::string> keys;
  for (const auto& entry : node) {
    if (!entry.first.IsScalar()) return problem(entry.first, "a key must be plain text");
    const std::string& key = entry.first.Scalar();
    if (!keys.insert(key).second) {
      return problem(entry.first, fmt::format("key '{}' stands twice; keep one of them", key));
    }
    if (Status status = checkTree(entry.second, path, depth + 1, nodes); !status) return status;
  }
  return {};
}

}  // namespace

YamlNode::YamlNode(YAML::Node node, std::string file, std::string path)
    : node_(std::move(node)), file_(std::move(file)), path_(std::move(path)) {}

void YamlNode::fail(const std::string& message) const {
  const int line = node_.IsDefined() ? node_.Mark().line + 1 : 0;
  throw YamlError(fmt::format("{}{}: {}{}", file_, line > 0 ? fmt::format(":{}", line) : "",
                              path_.empty() ? "" : path_ + ": ", message));
}

bool YamlNode::has(const std::string& key) const {
  return node_.IsMap() && node_[key].IsDefined();
}

YamlNode YamlNode::at(const std::string& key) const {
  if (!node_.IsMap())
    fail(fmt::format("expected a map with key '{}', found {}", key, shown(node_)));
  const YAML::Node child = node_[key];
  if (!child.IsDefined()) fail(fmt::format("missing key '{}'", key));
  return {child, file_, path_.empty() ? key : path_ + "." + key};
}

YamlNode YamlNode::at(std::size_t index) const {
  if (index >= size()) fail(fmt::format("expected more than {} entries, found {}", index, size()));
  return {node_[index], file_, fmt::format("{}[{}]", path_, index)};
}

std::size_t YamlNode::size() const {
  return node_.IsSequence() || node_.IsMap() ? node_.size() : 0;
}

bool YamlNode::isMap() const {
  return node_.IsMap();
}

bool YamlNode::isSequence() const {
  return node_.IsSequence();
}

std::vector<std::string> YamlNode::keys() const {
  if (!node_.IsMap()) fail(fmt::format("expected a map, found {}", shown(node_)));
  std::vector<std::string> names;
  for (const auto& entry : node_) names.push_back(entry.first.as<std::string>());
  return names;
}

double YamlNode::asDouble() const {
  try {
    const double value = node_.as<double>();
    if (std::isfinite(value)) return value;
  } catch (const YAML::Exception&) {
  }
  fail(fmt::format("expected a finite number, found {}", shown(node_)));
}

int YamlNode::asInt() const {
  try {
    return node_.as<int>();
  } catch (const YAML::Exception&) {
    fail(fmt::format("expected a whole number, found {}", shown(node_)));
  }
}

bool YamlNode::asBool() const {
  try {
    return node_.as<bool>();
  } catch (const YAML::Exception&) {
    fail(fmt::format("expected true or false, found {}", shown(node_)));
  }
}

std::string YamlNode::asString() const {
  if (!node_.IsScalar()) fail(fmt::format("expected text, found {}", shown(node_)));
  return node_.Scalar();
}

std::vector<double> YamlNode::asDoubles() const {
  if (!node_.IsSequence()) fail(fmt::format("expected a list of numbers, found {}", shown(node_)));
  std::vector<double> values;
  for (std::size_t i = 0; i < node_.size(); ++i) {
    const YamlNode child = at(i);
    if (child.isSequence()) {
      const std::vector<double> row = child.asDoubles();
      values.insert(values.end(), row.begin(), row.end());
    } else {
      values.push_back(child.asDouble());
    }
  }
  return values;
}

Eigen::VectorXd YamlNode::asVector(int size) const {
  const std::vector<double> values = asDoubles();
  if (static_cast<int>(values.size()) != size) {
    fail(fmt::format("expected {} numbers, found {}", size, values.size()));
  }
  return Eigen::Map<const Eigen::VectorXd>(values.data(), size);
}

Eigen::Matrix4d YamlNode::asMatrix4() const {
  if (isMap()) {
    allowOnly({"rows", "cols", "data", "dt"});
    if (at("rows").asInt() != 4 || at("cols").asInt() != 4) fail("expected a 4 x 4 matrix");
    return at("data").asMatrix4();
  }
  const Eigen::VectorXd values = asVector(16);
  return Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(values.data());
}

void YamlNode::allowOnly(std::initializer_list<const char*> known) const {
  for (const std::string& key : keys()) {
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      const YAML::Node child = node_[key];
      const YamlNode where{child, file_, path_};
      where.fail(fmt::format("unknown key '{}'; known keys: {}", key,
                             fmt::join(known.begin(), known.end(), ", ")));
    }
  }
}

Result<YamlNode> openYaml(const std::string& path) {
  std::error_code code;
  if (std::filesystem::is_directory(path, code)) {
    return Error{fmt::format("{}: is a folder; expected a YAML file", path)};
  }
  std::ifstream stream(path);
  if (!stream) return Error{fmt::format("{}: cannot open the file for reading", path)};
  std::stringstream content;
  content << stream.rdbuf();
  return openYamlText(content.str(), path);
}

Result<YamlNode> openYamlText(std::string text, const std::string& path) {
  // OpenCV writes a directive that YAML does not know; blank it and keep the line count.
  if (text.rfind("%YAML:", 0) == 0) text.replace(0, text.find('\n'), "#");
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.size() > 1) {
      return Error{fmt::format("{}:{}: a second document begins; one file holds one", path,
                               documents[1].Mark().line + 1)};
    }
    const YAML::Node root = documents.empty() ? YAML::Node() : documents.front();
    if (!root.IsDefined() || root.IsNull())
      return Error{fmt::format("{}: the file is empty", path)};
    std::size_t nodes = 0;
    if (Status sound = checkTree(root, path, 0, nodes); !sound) return sound.error();
    return YamlNode{root, path, ""};
  } catch (const YAML::Exception& error) {
    return Error{fmt::format("{}:{}: not valid YAML: {}", path, error.mark.line + 1, error.msg)};
  }
}

}  // namespace parkade
