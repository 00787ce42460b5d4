#include "toml_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "error.h"

namespace runner {
namespace {

std::string type_name(const toml::node &node) {
  std::ostringstream text;
  text << node.type();
  return text.str();
}

} // namespace

TomlTable::TomlTable(const toml::table &table, const std::filesystem::path &file, std::string name)
    : table_(&table), file_(&file), name_(std::move(name)) {}

const toml::node *TomlTable::find(std::string_view key) {
  known_.emplace_back(key);
  return table_->get(key);
}

bool TomlTable::has(std::string_view key) const { return table_->contains(key); }

Place TomlTable::place() const { return {static_cast<std::uint32_t>(table_->source().begin.line), name_}; }

void TomlTable::fail(std::string_view key, const std::string &what) const {
  const toml::node *node = table_->get(key);
  const auto line = node != nullptr ? node->source().begin.line : table_->source().begin.line;
  const std::string where = name_.empty() ? std::string(key) : fmt::format("{}.{}", name_, key);
  throw Error(fmt::format("{}:{}: {}: {}", file_->string(), line, where, what));
}

void TomlTable::fail_choice(std::string_view key, const std::string &given,
                            const std::vector<std::string_view> &names) const {
  fail(key, fmt::format("\"{}\" is not one of \"{}\"", given, fmt::join(names, "\", \"")));
}

void TomlTable::require(std::string_view key) const {
  if (!has(key)) fail(key, "the key is missing");
}

void TomlTable::finish() const {
  for (const auto &[key, node] : *table_) {
    if (std::find(known_.begin(), known_.end(), key.str()) != known_.end()) continue;
    // The position of a key is more precise than that of its value, which may start on a later line.
    const std::string where = name_.empty() ? std::string(key.str()) : fmt::format("{}.{}", name_, key.str());
    throw Error(fmt::format("{}:{}: {}: unknown key; known here: {}", file_->string(), key.source().begin.line, where,
                            fmt::join(known_, ", ")));
  }
}

double TomlTable::number(const toml::node &node, std::string_view key) const {
  double result = 0;
  if (const auto *floating = node.as_floating_point())
    result = floating->get();
  else if (const auto *whole = node.as_integer())
    result = static_cast<double>(whole->get());
  else
    fail(key, fmt::format("expected a number, found a value of type {}", type_name(node)));
  if (!std::isfinite(result)) fail(key, "expected a finite number");
  return result;
}

float TomlTable::single(const toml::node &node, std::string_view key) const {
  const double given = number(node, key);
  if (std::fabs(given) > std::numeric_limits<float>::max()) fail(key, fmt::format("{} is too large", given));
  return static_cast<float>(given);
}

std::int64_t TomlTable::integer(const toml::node &node, std::string_view key, std::int64_t least, std::int64_t most) const {
  const auto *whole = node.as_integer();
  if (whole == nullptr) fail(key, fmt::format("expected an integer, found a value of type {}", type_name(node)));
  const std::int64_t value = whole->get();
  if (value < least || value > most) fail(key, fmt::format("{} is not between {} and {}", value, least, most));
  return value;
}

const std::string &TomlTable::text(const toml::node &node, std::string_view key) const {
  const auto *string = node.as_string();
  if (string == nullptr) fail(key, fmt::format("expected a string, found a value of type {}", type_name(node)));
  return string->get();
}

void TomlTable::read(std::string_view key, double &value) {
  if (const toml::node *node = find(key)) value = number(*node, key);
}

void TomlTable::read(std::string_view key, float &value) {
  if (const toml::node *node = find(key)) value = single(*node, key);
}

void TomlTable::read(std::string_view key, std::uint32_t &value) {
  if (const toml::node *node = find(key))
    value = static_cast<std::uint32_t>(integer(*node, key, 0, std::numeric_limits<std::uint32_t>::max()));
}

void TomlTable::read(std::string_view key, std::uint64_t &value) {
  if (const toml::node *node = find(key))
    value = static_cast<std::uint64_t>(integer(*node, key, 0, std::numeric_limits<std::int64_t>::max()));
}

void TomlTable::read(std::string_view key, int &value) {
  if (const toml::node *node = find(key))
    value = static_cast<int>(integer(*node, key, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()));
}

void TomlTable::read(std::string_view key, bool &value) {
  const toml::node *node = find(key);
  if (node == nullptr) return;
  const auto *boolean = node->as_boolean();
  if (boolean == nullptr) fail(key, fmt::format("expected true or false, found a value of type {}", type_name(*node)));
  value = boolean->get();
}

void TomlTable::read(std::string_view key, std::string &value) {
  if (const toml::node *node = find(key)) value = text(*node, key);
}

void TomlTable::read(std::string_view key, Vector3 &value) {
  const toml::node *node = find(key);
  if (node == nullptr) return;
  const toml::array *array = node->as_array();
  if (array == nullptr)
    fail(key, fmt::format("expected three numbers [x, y, z], found a value of type {}", type_name(*node)));
  if (array->size() != 3) fail(key, fmt::format("expected three numbers [x, y, z], found {} values", array->size()));
  for (int axis = 0; axis < 3; ++axis) value[axis] = single(*array->get(static_cast<std::size_t>(axis)), key);
}

void TomlTable::read(std::string_view key, std::vector<std::string> &value) {
  const toml::node *node = find(key);
  if (node == nullptr) return;
  const toml::array *array = node->as_array();
  if (array == nullptr) fail(key, fmt::format("expected a list of strings, found a value of type {}", type_name(*node)));
  value.clear();
  for (const toml::node &each : *array) value.push_back(text(each, key));
}

std::optional<TomlTable> TomlTable::table(std::string_view key) {
  const toml::node *node = find(key);
  if (node == nullptr) return std::nullopt;
  const toml::table *table = node->as_table();
  if (table == nullptr) fail(key, fmt::format("expected a table, found a value of type {}", type_name(*node)));
  return TomlTable(*table, *file_, name_.empty() ? std::string(key) : fmt::format("{}.{}", name_, key));
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) {
  const toml::node *node = find(key);
  if (node == nullptr) return {};
  const toml::array *array = node->as_array();
  if (array == nullptr) fail(key, fmt::format("expected tables ([[{}]]), found a value of type {}", key, type_name(*node)));
  std::vector<TomlTable> result;
  for (std::size_t i = 0; i < array->size(); ++i) {
    const toml::table *table = array->get(i)->as_table();
    if (table == nullptr)
      fail(key, fmt::format("expected tables ([[{}]]), found a value of type {}", key, type_name(*array->get(i))));
    result.emplace_back(*table, *file_, fmt::format("{}{}{}[{}]", name_, name_.empty() ? "" : ".", key, i));
  }
  return result;
}

} // namespace runner
