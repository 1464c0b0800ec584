#include "foundation/config_reader.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>

#include <yaml-cpp/yaml.h>

#include "foundation/file_content.hpp"

namespace alight {
namespace config_detail {

ConfigNode::ConfigNode(const YAML::Node& node)
    : node_(node.IsDefined() ? std::make_shared<const YAML::Node>(node) : nullptr) {}

bool ConfigNode::is_defined() const { return node_ != nullptr; }
bool ConfigNode::is_null() const { return node_ != nullptr && node_->IsNull(); }
bool ConfigNode::is_scalar() const { return node_ != nullptr && node_->IsScalar(); }
bool ConfigNode::is_sequence() const { return node_ != nullptr && node_->IsSequence(); }
bool ConfigNode::is_map() const { return node_ != nullptr && node_->IsMap(); }
const std::string& ConfigNode::scalar() const { return node_->Scalar(); }
std::size_t ConfigNode::size() const { return node_->size(); }
ConfigNode ConfigNode::operator[](std::size_t i) const { return ConfigNode((*node_)[i]); }
ConfigNode ConfigNode::operator[](const std::string& key) const {
  return ConfigNode((*node_)[key]);  // that of a const map does not add the key
}

namespace {

/// Levenshtein distance, the measure of "did you mean".
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = diagonal + (a[i - 1] == b[j - 1] ? 0U : 1U);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitution});
    }
  }
  return row.back();
}

/// The whole scalar must be one number: "3x" and "" are no numbers.
template <class T>
bool parse_number(const ConfigNode& node, T& value) {
  if (!node.is_scalar() || node.yaml().Tag() == "!") return false;  // "!" marks a quoted scalar
  const std::string& text = node.scalar();
  const char* first = text.data() + (!text.empty() && text.front() == '+' ? 1 : 0);
  const auto [end, code] = std::from_chars(first, text.data() + text.size(), value);
  return code == std::errc() && end == text.data() + text.size();
}

template <class T>
std::string read_number(const ConfigNode& node, T& value, Bounds bounds, const char* expected) {
  T number{};
  if (!parse_number(node, number) || !std::isfinite(static_cast<double>(number))) return expected;
  const double as_double = static_cast<double>(number);
  if (as_double < bounds.min || as_double > bounds.max) return std::string(expected) + describe(bounds);
  value = number;
  return {};
}

}  // namespace

std::string read(const ConfigNode& node, bool& value, Bounds) {
  if (!node.is_scalar() || (node.scalar() != "true" && node.scalar() != "false")) return "true or false";
  value = node.scalar() == "true";
  return {};
}
std::string read(const ConfigNode& node, int& value, Bounds bounds) {
  return read_number(node, value, bounds, "a whole number");
}
std::string read(const ConfigNode& node, std::int64_t& value, Bounds bounds) {
  return read_number(node, value, bounds, "a whole number");
}
std::string read(const ConfigNode& node, double& value, Bounds bounds) {
  return read_number(node, value, bounds, "a number");
}
std::string read(const ConfigNode& node, std::string& value, Bounds) {
  if (!node.is_scalar()) return "text";
  value = node.scalar();
  return {};
}

std::string write(bool value) { return value ? "true" : "false"; }
std::string write(int value) { return std::to_string(value); }
std::string write(std::int64_t value) { return std::to_string(value); }
std::string write(double value) {
  std::array<char, 32> buffer{};  // the shortest text that reads back to the same double
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}
std::string write(const std::string& value) {
  YAML::Emitter emitter;
  emitter << YAML::DoubleQuoted << value;
  const bool plain = !value.empty() && std::all_of(value.begin(), value.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '/' || c == '.' || c == '-';
  });
  const bool starts_as_word =
      plain && (std::isalpha(static_cast<unsigned char>(value.front())) != 0 || value.front() == '/');
  const bool reserved = value == "none" || value == "true" || value == "false" || value == "null";
  return starts_as_word && !reserved ? value : emitter.c_str();
}

std::string describe(Bounds bounds) {
  const bool has_min = std::isfinite(bounds.min);
  const bool has_max = std::isfinite(bounds.max);
  if (!has_min && !has_max) return "";
  if (bounds.min == std::numeric_limits<double>::min())
    return has_max ? " (> 0, <= " + write(bounds.max) + ")" : " (> 0)";
  if (!has_max) return " (>= " + write(bounds.min) + ")";
  if (!has_min) return " (<= " + write(bounds.max) + ")";
  return " (" + write(bounds.min) + " .. " + write(bounds.max) + ")";
}

std::string nearest(const std::string& word, const std::vector<std::string>& known) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(3, word.size() / 2);
  for (const std::string& candidate : known) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

ConfigNode parse_text(const std::string& text, const std::string& name) {
  try {
    return YAML::Load(text);
  } catch (const YAML::Exception& e) {
    throw ConfigError(name + ":" + std::to_string(e.mark.line + 1) + ": not readable as YAML: " + e.msg);
  }
}

ConfigNode parse_file(const std::filesystem::path& path) {
  const std::optional<std::string> text = file_content(path);
  if (!text) throw ConfigError(path.string() + ": cannot be opened; check the path");
  return parse_text(*text, path.string());
}

}  // namespace config_detail

Binder::Shared Binder::start(const std::string& file, const std::vector<std::string>& overrides) {
  Shared shared;
  shared.file = file;
  for (const std::string& text : overrides) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw ConfigError("--set " + text + ": expected a.b=value");
    }
    const std::string path = text.substr(0, equals);
    shared.overrides[path] = config_detail::parse_text(text.substr(equals + 1), "--set " + path);
  }
  return shared;
}

void Binder::finish(const Shared& shared) {
  std::string message;
  for (const std::string& error : shared.errors) message += (message.empty() ? "" : "\n") + error;
  for (const auto& [path, node] : shared.overrides) {
    if (shared.overrides_used.count(path) != 0) continue;
    message +=
        (message.empty() ? "" : "\n") + ("--set " + path + ": no such key; --print-config lists all keys");
  }
  if (!message.empty()) throw ConfigError(message);
}

config_detail::ConfigNode Binder::take(const std::string& key) {
  known_.insert(key);
  const auto found = shared_->overrides.find(dotted(key));
  if (found != shared_->overrides.end()) {
    shared_->overrides_used.insert(found->first);
    return found->second;
  }
  return node_.is_map() ? node_[key] : ConfigNode();
}

config_detail::ConfigNode Binder::key_node(const std::string& key) const {
  if (!node_.is_map()) return {};
  for (const auto& pair : node_.yaml()) {
    if (pair.first.IsScalar() && pair.first.Scalar() == key) return pair.first;
  }
  return {};
}

bool Binder::is_section(const std::string& key) const { return node_.is_map() && node_[key].is_map(); }

std::vector<std::string> Binder::overrides_below(const std::string& path) const {
  const std::string begin = path + ".";
  std::vector<std::string> below;
  for (auto it = shared_->overrides.lower_bound(begin);
       it != shared_->overrides.end() && it->first.compare(0, begin.size(), begin) == 0; ++it) {
    below.push_back(it->first);
  }
  return below;
}

void Binder::refuse_section(const std::string& choice, const std::string& name) {
  const std::string message = "belongs to " + choice + ": " + name + ", and the " + choice + " is " +
                              chosen_.at(choice) + "; remove it or choose that " + choice;
  const std::vector<std::string> set = overrides_below(dotted(name));
  shared_->overrides_used.insert(set.begin(), set.end());
  if (take(name).is_defined()) return error(key_node(name), name, message);
  if (!set.empty()) shared_->errors.push_back("--set " + set.front() + ": " + message);
}

void Binder::ignore(const std::string& key) {
  if (printed_ == nullptr) known_.insert(key);
}

void Binder::check(const std::string& key, bool ok, const std::string& message) {
  if (printed_ != nullptr || ok || wrong_.count(key) != 0) return;
  error(take(key), key, message);
}

void Binder::report_leftovers() {
  if (!node_.is_map()) return;
  std::set<std::string> seen;
  const std::vector<std::string> known(known_.begin(), known_.end());
  for (const auto& pair : node_.yaml()) {
    const std::string key = pair.first.IsScalar() ? pair.first.Scalar() : "(not a word)";
    if (!seen.insert(key).second) error(pair.first, key, "is given twice");
    if (known_.count(key) != 0) continue;
    const std::string meant = config_detail::nearest(key, known);
    error(pair.first, key,
          "no such key" + (meant.empty() ? std::string() : "; did you mean \"" + meant + "\"?"));
  }
}

std::string Binder::place(const ConfigNode& node) const {
  const YAML::Mark mark = node.is_defined() ? node.yaml().Mark() : YAML::Mark::null_mark();
  return mark.line < 0 ? shared_->file + ":" : shared_->file + ":" + std::to_string(mark.line + 1) + ":";
}

void Binder::error(const ConfigNode& node, const std::string& key, const std::string& message) {
  wrong_.insert(key);
  const std::string path = key.empty() ? path_ : dotted(key);
  const bool set = shared_->overrides.count(path) != 0;
  std::string got;
  if (message.rfind("expected", 0) == 0 && node.is_defined()) {
    got = node.is_scalar() ? ", got \"" + node.scalar() + "\""
          : node.is_map()  ? ", got a section"
                           : ", got a list";
    if (node.is_null()) got = ", got nothing";
  }
  shared_->errors.push_back((set ? "--set" : place(node)) + " " + path + ": " + message + got);
}

void Binder::print_line(const std::string& key, const std::string& value, const std::string& help) {
  *printed_ +=
      std::string(static_cast<std::size_t>(indent_), ' ') + key + ": " + value + "  # " + help + "\n";
}

void Binder::print_comment(const std::string& text) {
  *printed_ += std::string(static_cast<std::size_t>(indent_), ' ') + "# " + text + "\n";
}

}  // namespace alight
