// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/networks/class_map.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "parkade/core/yaml.hpp"

namespace parkade {
namespace {

std::array<double, 3> threeNumbers(const YamlNode& node) {
  if (!node.isSequence()) {
    const double value = node.asDouble();
    return {value, value, value};
  }
  const Eigen::VectorXd values = node.asVector(3);
  return {values[0], values[1], values[2]};
}

int sideOf(const YamlNode& node) {
  const int value = node.asInt();
  if (value < 8 || value > 8192) node.fail(fmt::format("{} px; expected 8 to 8192", value));
  return value;
}

SemanticClass classOf(const YamlNode& node) {
  const std::string name = node.asString();
  const auto it = std::find(kSemanticClassNames.begin(), kSemanticClassNames.end(), name);
  if (it == kSemanticClassNames.end()) {
    std::string known;
    for (const std::string_view one : kSemanticClassNames) {
      known += (known.empty() ? "" : ", ") + std::string(one);
    }
    node.fail(fmt::format("class '{}' is unknown; known are {}", name, known));
  }
  return static_cast<SemanticClass>(it - kSemanticClassNames.begin());
}

ClassMap parseClassMap(const YamlNode& root, const std::string& path) {
  root.allowOnly({"network", "input", "classes", "unknown_is_unseen", "mirror"});
  ClassMap map;
  map.path = path;
  map.network =
      (std::filesystem::path(path).parent_path() / root.at("network").asString()).string();
  const YamlNode input = root.at("input");
  input.allowOnly({"width", "height", "any_size", "channels", "mean", "scale", "metres_per_px"});
  map.width = sideOf(input.at("width"));
  map.height = sideOf(input.at("height"));
  if (input.has("any_size")) map.any_size = input.at("any_size").asBool();
  if (input.has("channels")) {
    const std::string order = input.at("channels").asString();
    if (order != "rgb" && order != "bgr") {
      input.at("channels").fail(fmt::format("'{}'; expected rgb or bgr", order));
    }
    map.rgb = order == "rgb";
  }
  if (input.has("mean")) map.mean = threeNumbers(input.at("mean"));
  if (input.has("scale")) map.scale = threeNumbers(input.at("scale"));
  if (input.has("metres_per_px")) {
    map.metres_per_px = input.at("metres_per_px").asDouble();
    if (map.metres_per_px <= 0.0) input.at("metres_per_px").fail("expected a positive number");
  }
  const YamlNode classes = root.at("classes");
  if (!classes.isSequence() || classes.size() < 2) {
    classes.fail("expected a list of at least two class names, one per output channel");
  }
  for (std::size_t i = 0; i < classes.size(); ++i) map.classes.push_back(classOf(classes.at(i)));
  const bool floor =
      std::find(map.classes.begin(), map.classes.end(), SemanticClass::kFloor) != map.classes.end();
  if (map.metres_per_px > 0.0 && !floor) {
    classes.fail(
        "a network of bird's-eye pictures must tell floor: slots, lines and objects are found by "
        "it");
  }
  if (root.has("mirror")) map.mirror = root.at("mirror").asBool();
  if (root.has("unknown_is_unseen")) {
    const YamlNode unseen = root.at("unknown_is_unseen");
    map.unknown_is_unseen = unseen.asBool();
    const bool tells = std::any_of(map.classes.begin(), map.classes.end(),
                                   [](SemanticClass c) { return c != SemanticClass::kUnknown; });
    if (map.unknown_is_unseen && map.metres_per_px <= 0.0) {
      unseen.fail("only for networks of bird's-eye pictures (input: metres_per_px)");
    }
    if (map.unknown_is_unseen && !tells) unseen.fail("there is no class but unknown");
  }
  return map;
}

}  // namespace

Result<ClassMap> readClassMap(const std::string& path) {
  return parseYamlFile<ClassMap>(path,
                                 [&](const YamlNode& root) { return parseClassMap(root, path); });
}

Result<std::string> namedOrOwnModel(const std::string& path, const std::string& own_name) {
  return path.empty() ? findModel(own_name) : Result<std::string>(path);
}

Result<std::string> findModel(const std::string& name) {
  std::vector<std::string> folders;
  if (const char* folder = std::getenv("PARKADE_MODELS")) {
    std::error_code code;
    if (!std::filesystem::is_directory(folder, code)) {
      return Error{fmt::format("PARKADE_MODELS={}: there is no such folder", folder)};
    }
    folders.emplace_back(folder);
  }
  // Beside the running program first: an installation may have been moved as a whole.
  std::error_code no_link;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", no_link);
  if (!no_link) {
    folders.push_back((program.parent_path().parent_path() / "share/parkade/models").string());
  }
  folders.emplace_back(PARKADE_INSTALLED_MODELS);
  folders.emplace_back(PARKADE_SOURCE_MODELS);
  std::string looked;
  for (const std::string& folder : folders) {
    const std::string path = (std::filesystem::path(folder) / (name + ".yaml")).string();
    std::error_code code;
    if (std::filesystem::exists(path, code)) return path;
    looked += "\n  " + path;
  }
  return Error{fmt::format(
      "network {}: no class map found (set PARKADE_MODELS to the folder models); looked for{}",
      name, looked)};
}

}  // namespace parkade
