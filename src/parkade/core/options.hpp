// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "parkade/core/result.hpp"

namespace parkade {

/// Visits the fields of an options struct. Options are nested plain structs that list their fields:
///
///     struct WindowOptions {
///       int keyframes = 8;
///       void visit(OptionVisitor& v) {
///         v.field("keyframes", keyframes, "count", "Keyframes kept in the window.", 2, 50);
///       }
///     };
///     struct VioOptions {
///       WindowOptions window;
///       void visit(OptionVisitor& v) { v.group("window", window); }
///     };
///
/// One list serves files, --set, --help and the effective configuration that every run saves.
class OptionVisitor {
 public:
  static constexpr double kInf = std::numeric_limits<double>::infinity();
  virtual ~OptionVisitor() = default;

  virtual void field(const char* name, double& value, const char* unit, const char* help,
                     double min = -kInf, double max = kInf) = 0;
  virtual void field(const char* name, int& value, const char* unit, const char* help,
                     double min = -kInf, double max = kInf) = 0;
  virtual void field(const char* name, bool& value, const char* help) = 0;
  /// An empty list of choices allows any text.
  virtual void field(const char* name, std::string& value, const char* help,
                     const std::vector<std::string>& choices = {}) = 0;

  template <class Group>
  void group(const char* name, Group& options) {
    enter(name);
    options.visit(*this);
    leave();
  }

 protected:
  virtual void enter(const char* name) = 0;
  virtual void leave() = 0;
};

/// Any options struct, as the functions below take it: asOptions(my_options).
using OptionTree = std::function<void(OptionVisitor&)>;

template <class Options>
OptionTree asOptions(Options& options) {
  return [&options](OptionVisitor& visitor) { options.visit(visitor); };
}

/// Sets one field from "window.keyframes=8". Fails on an unknown name (and lists near ones), on a
/// value of the wrong type, outside its range or not among its choices; nothing is changed then.
Status setOption(const OptionTree& options, const std::string& assignment);

/// Sets fields from a YAML file of nested maps; missing keys keep their values, unknown keys fail.
Status loadOptions(const OptionTree& options, const std::string& path);

/// The values as YAML that loadOptions reads back to the same bits.
std::string dumpOptions(const OptionTree& options);

/// One line per field: dotted name, default, unit, range, sentence. For --help.
std::string describeOptions(const OptionTree& options);

}  // namespace parkade
