// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/bench_key.hpp"

#include <fmt/core.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <set>
#include <string>

#include "parkade/cli/child_process.hpp"
#include "parkade/core/random.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/trajectory_io.hpp"
#include "parkade/semantics/networks/class_map.hpp"
#include "parkade/semantics/networks/segmentation.hpp"

namespace parkade::cli {
namespace {

namespace fs = std::filesystem;

std::uint64_t hashOf(const std::string& bytes, std::uint64_t start = 0) {
  std::uint64_t hash = start;
  for (const char c : bytes) hash = hash64(hash, static_cast<unsigned char>(c));
  return hash;
}

// Of large files; 0 where there is none.
std::uint64_t fileHash(const std::string& path) {
  const Result<std::string> bytes = readFile(path);
  return bytes ? std::hash<std::string>{}(*bytes) : 0U;
}

// Another build gives other figures: they must not stand in one table.
std::uint64_t programHash() {
  static const std::uint64_t kHash = fileHash(programPath());
  return kHash;
}

// Adds the files of a folder, but for notes to people; with a stem, those alone that have it.
void addFiles(const fs::path& folder, const std::string& stem, std::set<fs::path>& files) {
  std::error_code code;
  for (fs::directory_iterator at(folder, code), end; !code && at != end; at.increment(code)) {
    std::error_code no_file;
    const fs::path& path = at->path();
    const bool wanted = path.extension() != ".md" && (stem.empty() || path.stem() == stem);
    if (wanted && at->is_regular_file(no_file)) files.insert(path);
  }
}

// Own networks may come from several folders; an ONNX file lies beside its class map.
std::set<fs::path> networkFiles(const BenchVariant& variant) {
  std::set<fs::path> files;
  if (variant.run_method == "vis") return files;
  for (const char* name : {kBevNetwork, kViewNetwork, "zone_text", "slot_number"}) {
    const Result<std::string> own = findModel(name);
    if (own) addFiles(fs::path(*own).parent_path(), "", files);
  }
  for (const std::string& setting : variant.settings) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos) continue;
    const fs::path named = setting.substr(equals + 1);
    std::error_code code;
    if (!fs::is_regular_file(named, code)) continue;
    files.insert(named);
    addFiles(named.has_parent_path() ? named.parent_path() : ".", named.stem().string(), files);
  }
  return files;
}

}  // namespace

std::string textOrEmpty(const std::string& path) {
  const Result<std::string> text = readFile(path);
  return text ? *text : "";
}

std::string runKey(const BenchVariant& variant, const RunInputs& inputs) {
  std::string text = variant.run_method + "\n" + inputs.cameras + "\n";
  for (const std::string& setting : variant.settings) text += setting + "\n";
  for (const char* file : {"spec.yaml", "rig.yaml", "truth/garage.json", "truth/agents.csv"}) {
    text += textOrEmpty(joinPath(inputs.sequence, file));
  }
  const Result<std::string> reference = findReference(inputs.sequence);
  if (reference) text += textOrEmpty(*reference);
  if (!variant.import_folder.empty()) {
    text += textOrEmpty(inputs.trajectory);
  } else {
    text += fmt::format("{} threads\n", inputs.threads);
    for (const fs::path& file : networkFiles(variant)) {
      text += fmt::format("{} {:x}\n", file.filename().string(), fileHash(file.string()));
    }
  }
  return fmt::format("{:016x}", hashOf(text, programHash()));
}

}  // namespace parkade::cli
