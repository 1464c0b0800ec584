#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "foundation/errors.hpp"

namespace YAML {
class Node;
}

namespace alight {

/// Inclusive limits of a number; checked on loading, printed by `--print-config`.
struct Bounds {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};
constexpr Bounds at_least(double min) { return {min, std::numeric_limits<double>::infinity()}; }
constexpr Bounds between(double min, double max) { return {min, max}; }
/// Greater than zero (the smallest positive double is the limit).
constexpr Bounds positive() { return at_least(std::numeric_limits<double>::min()); }

namespace config_detail {
/// A node of a YAML document, behind a pointer: who binds parses none of yaml-cpp.
class ConfigNode {
 public:
  ConfigNode() = default;              // absent
  ConfigNode(const YAML::Node& node);  // NOLINT(google-explicit-constructor): the same thing

  bool is_defined() const;
  bool is_null() const;
  bool is_scalar() const;
  bool is_sequence() const;
  bool is_map() const;
  /// `none` or nothing where there may be a value.
  bool is_none() const { return is_null() || (is_scalar() && scalar() == "none"); }
  const std::string& scalar() const;
  /// Of a sequence or map.
  std::size_t size() const;
  /// An element of a sequence.
  ConfigNode operator[](std::size_t i) const;
  /// A value of a map; absent where there is none.
  ConfigNode operator[](const std::string& key) const;

  /// Not of an absent node.
  const YAML::Node& yaml() const { return *node_; }

 private:
  std::shared_ptr<const YAML::Node> node_;
};
}  // namespace config_detail

template <class T>
T bind_node(const config_detail::ConfigNode& document, const std::string& file,
            const std::vector<std::string>& overrides = {});
template <class T>
std::string print_config(const T& value);

/// Visits the fields of a plain struct. One `bind` function per struct is the only list of its fields; the
/// same function loads them from YAML, checks them and prints them:
///
///     struct CropConfig { int width_px = 352; };
///     void bind(Binder& b, CropConfig& c) {
///       b.field("width_px", c.width_px, "width of the crop", at_least(1));
///     }
///     CropConfig c = load_config<CropConfig>("crop.yaml");
///
/// All mistakes of a file are collected, then thrown as one ConfigError: unknown and duplicate keys (with the
/// nearest known key), wrong types, numbers out of bounds, missing required keys. Keys that are absent keep
/// the struct's default.
class Binder {
 public:
  /// Supported types: bool, int, std::int64_t, double, std::string, std::vector<int>, std::vector<double>,
  /// std::vector<std::string>, std::vector<std::vector<double>> and std::optional of all of these
  /// (written `none` in YAML).
  template <class T>
  void field(const std::string& key, T& value, const std::string& help, Bounds bounds = {});

  /// As field, but absence is an error.
  template <class T>
  void required(const std::string& key, T& value, const std::string& help, Bounds bounds = {});

  /// A name out of a fixed list: `b.choice("reduction", c.reduction, {{"mean", kMean}, {"min", kMin}},
  /// "...")`.
  template <class Enum>
  void choice(const std::string& key, Enum& value, const std::vector<std::pair<std::string, Enum>>& names,
              const std::string& help);

  /// A nested struct with a `bind` of its own.
  template <class S>
  void section(const std::string& key, S& value, const std::string& help);

  /// A nested struct that may be absent (`none`).
  template <class S>
  void section(const std::string& key, std::optional<S>& value, const std::string& help);

  /// A nested struct that belongs to one name of a choice and has that name as its key. The choice has to be bound
  /// before it. While another name is chosen the section would have no effect: it is a mistake to give it, in the file
  /// or by --set, and it is not printed.
  template <class S>
  void section_of(const std::string& choice, const std::string& name, S& value, const std::string& help);

  /// A list of nested structs.
  template <class S>
  void list(const std::string& key, std::vector<S>& values, const std::string& help);

  /// A rule that a type or bound cannot say; the message gets the key's file and line.
  void check(const std::string& key, bool ok, const std::string& message);

  /// A key that other programs write and that we know but do not use.
  void ignore(const std::string& key);

  /// True if the key holds a section rather than a value, for keys that take either.
  bool is_section(const std::string& key) const;

  /// Found so far in the whole file.
  std::size_t mistakes() const { return shared_ == nullptr ? 0 : shared_->errors.size(); }

  /// False while printing: checks that need the loaded values can be left out.
  bool loading() const { return printed_ == nullptr; }

 private:
  using ConfigNode = config_detail::ConfigNode;

  template <class T>
  friend T bind_node(const config_detail::ConfigNode&, const std::string&, const std::vector<std::string>&);
  template <class T>
  friend std::string print_config(const T&);

  struct Shared {
    std::string file;
    std::map<std::string, ConfigNode> overrides;  // dotted path -> value of --set
    std::set<std::string> overrides_used;
    std::vector<std::string> errors;
  };

  Binder(Shared& shared, ConfigNode node, std::string path)
      : shared_(&shared), node_(std::move(node)), path_(std::move(path)) {}
  Binder(std::string& printed, int indent) : printed_(&printed), indent_(indent) {}

  static Shared start(const std::string& file, const std::vector<std::string>& overrides);
  static void finish(const Shared& shared);

  /// The key's value from --set or the file; null where absent. Notes that the key is known.
  ConfigNode take(const std::string& key);
  /// The key itself, which knows its line; absent where the file does not give it.
  ConfigNode key_node(const std::string& key) const;
  /// Unknown and duplicate keys of this map.
  void report_leftovers();
  std::string dotted(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }
  std::string place(const ConfigNode& node) const;
  void error(const ConfigNode& node, const std::string& key, const std::string& message);
  void print_line(const std::string& key, const std::string& value, const std::string& help);
  void print_comment(const std::string& text);
  /// Paths of --set below a section.
  std::vector<std::string> overrides_below(const std::string& path) const;
  /// The mistake of section_of, if the section is given.
  void refuse_section(const std::string& choice, const std::string& name);

  template <class T>
  bool load(const std::string& key, T& value, Bounds bounds);

  Shared* shared_ = nullptr;
  ConfigNode node_;
  std::string path_;
  std::set<std::string> known_;
  std::set<std::string> wrong_;                // keys with an error already: one message a key
  std::map<std::string, std::string> chosen_;  // key of a choice -> name
  std::string* printed_ = nullptr;
  int indent_ = 0;
};

namespace config_detail {
/// Empty on success, else what was expected.
std::string read(const ConfigNode& node, bool& value, Bounds bounds);
std::string read(const ConfigNode& node, int& value, Bounds bounds);
std::string read(const ConfigNode& node, std::int64_t& value, Bounds bounds);
std::string read(const ConfigNode& node, double& value, Bounds bounds);
std::string read(const ConfigNode& node, std::string& value, Bounds bounds);
template <class T>
std::string read(const ConfigNode& node, std::vector<T>& value, Bounds bounds) {
  if (!node.is_sequence()) return "a list";
  value.clear();
  for (std::size_t i = 0; i < node.size(); ++i) {
    T item{};
    if (std::string expected = read(node[i], item, bounds); !expected.empty())
      return "a list of which each is " + expected;
    value.push_back(std::move(item));
  }
  return {};
}
template <class T>
std::string read(const ConfigNode& node, std::optional<T>& value, Bounds bounds) {
  if (node.is_none()) {
    value.reset();
    return {};
  }
  T item{};
  if (std::string expected = read(node, item, bounds); !expected.empty()) return expected + ", or none";
  value = std::move(item);
  return {};
}

std::string write(bool value);
std::string write(int value);
std::string write(std::int64_t value);
std::string write(double value);
std::string write(const std::string& value);
template <class T>
std::string write(const std::vector<T>& values) {
  std::string text;
  for (const T& value : values) text += (text.empty() ? "" : ", ") + write(value);
  return "[" + text + "]";
}
template <class T>
std::string write(const std::optional<T>& value) {
  return value ? write(*value) : "none";
}

std::string describe(Bounds bounds);
std::string nearest(const std::string& word, const std::vector<std::string>& known);
ConfigNode parse_file(const std::filesystem::path& path);
ConfigNode parse_text(const std::string& text, const std::string& name);
}  // namespace config_detail

template <class T>
bool Binder::load(const std::string& key, T& value, Bounds bounds) {
  const ConfigNode node = take(key);
  if (!node.is_defined()) return false;
  if (const std::string expected = config_detail::read(node, value, bounds); !expected.empty()) {
    error(node, key, "expected " + expected);
  }
  return true;
}

template <class T>
void Binder::field(const std::string& key, T& value, const std::string& help, Bounds bounds) {
  if (printed_ != nullptr)
    return print_line(key, config_detail::write(value), help + config_detail::describe(bounds));
  load(key, value, bounds);
}

template <class T>
void Binder::required(const std::string& key, T& value, const std::string& help, Bounds bounds) {
  if (printed_ != nullptr) return field(key, value, help, bounds);
  if (!load(key, value, bounds)) error(node_, key, "is missing (" + help + ")");
}

template <class Enum>
void Binder::choice(const std::string& key, Enum& value,
                    const std::vector<std::pair<std::string, Enum>>& names, const std::string& help) {
  std::string all;
  std::string current;
  for (const auto& [name, number] : names) {
    all += (all.empty() ? "" : " | ") + name;
    if (number == value) current = name;
  }
  chosen_[key] = current;
  if (printed_ != nullptr) return print_line(key, current, help + " (" + all + ")");
  const ConfigNode node = take(key);
  if (!node.is_defined()) return;
  for (const auto& [name, number] : names) {
    if (node.is_scalar() && node.scalar() == name) {
      value = number;
      chosen_[key] = name;
      return;
    }
  }
  error(node, key, "expected one of " + all);
}

template <class S>
void Binder::section(const std::string& key, S& value, const std::string& help) {
  if (printed_ != nullptr) {
    print_comment(help);
    *printed_ += std::string(static_cast<std::size_t>(indent_), ' ') + key + ":\n";
    Binder nested(*printed_, indent_ + 2);
    bind(nested, value);
    return;
  }
  const ConfigNode node = take(key);
  if (node.is_defined() && !node.is_map())
    return error(node, key, "expected a section of its own, with indented keys");
  Binder nested(*shared_, node, dotted(key));
  bind(nested, value);
  nested.report_leftovers();
}

template <class S>
void Binder::section(const std::string& key, std::optional<S>& value, const std::string& help) {
  if (printed_ != nullptr) return value ? section(key, *value, help) : print_line(key, "none", help);
  const ConfigNode node = take(key);
  if (node.is_defined() && node.is_none()) return value.reset();
  if (!node.is_defined() && overrides_below(dotted(key)).empty()) return;
  if (!value) value.emplace();
  section(key, *value, help);
}

template <class S>
void Binder::section_of(const std::string& choice, const std::string& name, S& value,
                        const std::string& help) {
  // A wrong name is a mistake of its own: which section belongs to it nobody knows.
  if (chosen_.at(choice) == name || wrong_.count(choice) != 0) return section(name, value, help);
  if (loading()) refuse_section(choice, name);
}

template <class S>
void Binder::list(const std::string& key, std::vector<S>& values, const std::string& help) {
  if (printed_ != nullptr) {
    if (values.empty()) return print_line(key, "[]", help);
    print_comment(help);
    const std::string margin(static_cast<std::size_t>(indent_), ' ');
    *printed_ += margin + key + ":\n";
    for (S& value : values) {
      std::string item;
      Binder nested(item, indent_ + 4);
      bind(nested, value);
      const std::size_t first = item.find_first_not_of(' ');
      if (first != std::string::npos) item.replace(first - 2, 1, "-");
      *printed_ += item;
    }
    return;
  }
  const ConfigNode node = take(key);
  if (!node.is_defined()) return;
  if (!node.is_sequence()) return error(node, key, "expected a list, each item beginning with \"-\"");
  values.clear();
  for (std::size_t i = 0; i < node.size(); ++i) {
    Binder nested(*shared_, node[i], dotted(key) + "." + std::to_string(i));
    values.emplace_back();
    if (!node[i].is_map()) {
      nested.error(node[i], "", "expected a section with keys");
      continue;
    }
    bind(nested, values.back());
    nested.report_leftovers();
  }
}

/// Binds a parsed document. `overrides` are `a.b=value`, as given to `--set`.
/// @throws ConfigError with all mistakes, one a line.
template <class T>
T bind_node(const config_detail::ConfigNode& document, const std::string& file,
            const std::vector<std::string>& overrides) {
  Binder::Shared shared = Binder::start(file, overrides);
  T value{};
  Binder binder(shared, document, "");
  if (document.is_defined() && !document.is_null() && !document.is_map()) {
    throw ConfigError(file + ":1: expected keys and values");
  }
  bind(binder, value);
  binder.report_leftovers();
  Binder::finish(shared);
  return value;
}

/// Reads and checks a YAML file. @throws ConfigError
template <class T>
T load_config(const std::filesystem::path& path, const std::vector<std::string>& overrides = {}) {
  return bind_node<T>(config_detail::parse_file(path), path.string(), overrides);
}

/// Reads and checks YAML text; `name` stands for the file in messages. @throws ConfigError
template <class T>
T parse_config(const std::string& text, const std::string& name,
               const std::vector<std::string>& overrides = {}) {
  return bind_node<T>(config_detail::parse_text(text, name), name, overrides);
}

/// The values as YAML with a comment a key; load_config reads it back to equal values.
template <class T>
std::string print_config(const T& value) {
  std::string text;
  Binder binder(text, 0);
  T copy = value;
  bind(binder, copy);
  return text;
}

}  // namespace alight
