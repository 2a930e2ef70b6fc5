// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/core/options.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "parkade/core/yaml.hpp"

namespace parkade {
namespace {

std::string inBrackets(const std::string& unit) {
  return unit.empty() ? "" : " (" + unit + ")";
}

// A visitor that knows the dotted name of the field at hand.
class PathVisitor : public OptionVisitor {
 protected:
  void enter(const char* name) override { groups_.emplace_back(name); }
  void leave() override { groups_.pop_back(); }
  [[nodiscard]] std::string pathOf(const char* name) const {
    return groups_.empty() ? name : fmt::format("{}.{}", fmt::join(groups_, "."), name);
  }
  std::vector<std::string> groups_;
};

std::string rangeText(double min, double max) {
  if (std::isinf(min) && std::isinf(max)) return {};
  if (std::isinf(max)) return fmt::format(">= {}", min);
  if (std::isinf(min)) return fmt::format("<= {}", max);
  return fmt::format("{} to {}", min, max);
}

template <class Number>
std::optional<Number> parseNumber(const std::string& text) {
  Number value{};
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if constexpr (std::is_floating_point_v<Number>) {
    if (!std::isfinite(value)) return std::nullopt;
  }
  return value;
}

// Sets fields from texts by dotted name. Two passes use it: one that only checks, one that sets, so
// that a bad value changes nothing.
class SettingVisitor : public PathVisitor {
 public:
  struct Entry {
    std::string text;
    std::string where;  // "--set" or file:line
    bool used = false;
  };
  SettingVisitor(std::map<std::string, Entry>& entries, bool apply)
      : entries_(entries), apply_(apply) {}

  void field(const char* name, double& value, const char* unit, const char*, double min,
             double max) override {
    number(name, value, unit, min, max, "a number");
  }
  void field(const char* name, int& value, const char* unit, const char*, double min,
             double max) override {
    number(name, value, unit, min, max, "a whole number");
  }
  void field(const char* name, bool& value, const char*) override {
    const Entry* entry = take(name);
    if (entry == nullptr) return;
    const bool is_true = entry->text == "true" || entry->text == "1" || entry->text == "on";
    const bool is_false = entry->text == "false" || entry->text == "0" || entry->text == "off";
    if (!is_true && !is_false) {
      problem(*entry, name, "expected true or false, or on or off");
    } else if (apply_) {
      value = is_true;
    }
  }
  void field(const char* name, std::string& value, const char*,
             const std::vector<std::string>& choices) override {
    const Entry* entry = take(name);
    if (entry == nullptr) return;
    if (!choices.empty() &&
        std::find(choices.begin(), choices.end(), entry->text) == choices.end()) {
      problem(*entry, name, fmt::format("expected one of {}", fmt::join(choices, ", ")));
    } else if (apply_) {
      value = entry->text;
    }
  }

  [[nodiscard]] const std::string& problems() const { return problems_; }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

 private:
  template <class Number>
  void number(const char* name, Number& value, const char* unit, double min, double max,
              const char* kind) {
    const Entry* entry = take(name);
    if (entry == nullptr) return;
    const std::optional<Number> parsed = parseNumber<Number>(entry->text);
    if (!parsed) {
      problem(*entry, name, fmt::format("expected {}{}", kind, inBrackets(unit)));
    } else if (static_cast<double>(*parsed) < min || static_cast<double>(*parsed) > max) {
      problem(*entry, name, fmt::format("expected {}{}", rangeText(min, max), inBrackets(unit)));
    } else if (apply_) {
      value = *parsed;
    }
  }
  const Entry* take(const char* name) {
    names_.push_back(pathOf(name));
    const auto it = entries_.find(names_.back());
    if (it == entries_.end()) return nullptr;
    it->second.used = true;
    return &it->second;
  }
  void problem(const Entry& entry, const char* name, const std::string& message) {
    if (!problems_.empty()) problems_ += '\n';
    problems_ +=
        fmt::format("{}: {}: {}, found '{}'", entry.where, pathOf(name), message, entry.text);
  }

  std::map<std::string, Entry>& entries_;
  bool apply_;
  std::string problems_;
  std::vector<std::string> names_;
};

// "; did you mean: " and names that share their last part or a good piece of text with the unknown
// one; where there are few options, all of them; nothing where no name is near.
std::string nearNames(const std::string& unknown, const std::vector<std::string>& names) {
  const auto lastPart = [](const std::string& name) {
    const std::size_t dot = name.rfind('.');
    return dot == std::string::npos ? name : name.substr(dot + 1);
  };
  const std::string wanted = lastPart(unknown);
  std::vector<std::string> near;
  for (const std::string& name : names) {
    const std::string last = lastPart(name);
    if (last.find(wanted) != std::string::npos || wanted.find(last) != std::string::npos ||
        last.substr(0, 4) == wanted.substr(0, 4)) {
      near.push_back(name);
    }
  }
  constexpr std::size_t kMaxShown = 12;
  if (near.empty() && names.size() <= kMaxShown) near = names;
  if (near.empty()) return "";
  const bool cut = near.size() > kMaxShown;
  if (cut) near.resize(kMaxShown);
  return fmt::format("; did you mean: {}{}", fmt::join(near, ", "), cut ? ", ..." : "");
}

Status setEntries(const OptionTree& options, std::map<std::string, SettingVisitor::Entry> entries) {
  SettingVisitor check(entries, false);
  options(check);
  std::string problems = check.problems();
  for (const auto& [name, entry] : entries) {
    if (entry.used) continue;
    if (!problems.empty()) problems += '\n';
    problems +=
        fmt::format("{}: unknown option '{}'{}", entry.where, name, nearNames(name, check.names()));
  }
  if (!problems.empty()) return Error{problems};
  SettingVisitor apply(entries, true);
  options(apply);
  return {};
}

void flatten(const YamlNode& node, const std::string& prefix,
             std::map<std::string, SettingVisitor::Entry>& entries) {
  for (const std::string& key : node.keys()) {
    const YamlNode child = node.at(key);
    const std::string path = prefix.empty() ? key : prefix + "." + key;
    if (child.isMap()) {
      flatten(child, path, entries);
    } else {
      entries[path] = {child.asString(),
                       fmt::format("{}:{}", node.file(), child.raw().Mark().line + 1)};
    }
  }
}

class DumpVisitor : public PathVisitor {
 public:
  void field(const char* name, double& value, const char*, const char*, double, double) override {
    line(name, fmt::format("{}", value));
  }
  void field(const char* name, int& value, const char*, const char*, double, double) override {
    line(name, fmt::format("{}", value));
  }
  void field(const char* name, bool& value, const char*) override {
    line(name, value ? "true" : "false");
  }
  void field(const char* name, std::string& value, const char*,
             const std::vector<std::string>&) override {
    std::string quoted;
    for (const char c : value) quoted += c == '\'' ? std::string("''") : std::string(1, c);
    line(name, "'" + quoted + "'");
  }
  std::string text;

 protected:
  void enter(const char* name) override {
    text += std::string(2 * groups_.size(), ' ') + name + ":\n";
    PathVisitor::enter(name);
  }

 private:
  void line(const char* name, const std::string& value) {
    text += std::string(2 * groups_.size(), ' ') + name + ": " + value + "\n";
  }
};

class DescribeVisitor : public PathVisitor {
 public:
  void field(const char* name, double& value, const char* unit, const char* help, double min,
             double max) override {
    line(name, fmt::format("{} {}", value, unit), rangeText(min, max), help);
  }
  void field(const char* name, int& value, const char* unit, const char* help, double min,
             double max) override {
    line(name, fmt::format("{} {}", value, unit), rangeText(min, max), help);
  }
  void field(const char* name, bool& value, const char* help) override {
    line(name, value ? "true" : "false", "", help);
  }
  void field(const char* name, std::string& value, const char* help,
             const std::vector<std::string>& choices) override {
    line(name, value.empty() ? "''" : value, fmt::format("{}", fmt::join(choices, "|")), help);
  }
  std::string text;

 private:
  void line(const char* name, const std::string& value, const std::string& range,
            const char* help) {
    text += fmt::format("  {:<44} {:<18} {} {}{}\n", pathOf(name), value, help,
                        range.empty() ? "" : "[", range.empty() ? "" : range + "]");
  }
};

}  // namespace

Status setOption(const OptionTree& options, const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) {
    return Error{fmt::format("--set: expected NAME=VALUE, found '{}'", assignment)};
  }
  return setEntries(options, {{assignment.substr(0, equals),
                               {assignment.substr(equals + 1), "--set " + assignment, false}}});
}

Status loadOptions(const OptionTree& options, const std::string& path) {
  Result<std::map<std::string, SettingVisitor::Entry>> entries =
      parseYamlFile<std::map<std::string, SettingVisitor::Entry>>(path, [](const YamlNode& root) {
        std::map<std::string, SettingVisitor::Entry> flat;
        flatten(root, "", flat);
        return flat;
      });
  if (!entries) return entries.error();
  return setEntries(options, std::move(*entries));
}

std::string dumpOptions(const OptionTree& options) {
  DumpVisitor visitor;
  options(visitor);
  return visitor.text;
}

std::string describeOptions(const OptionTree& options) {
  DescribeVisitor visitor;
  options(visitor);
  return visitor.text;
}

}  // namespace parkade
