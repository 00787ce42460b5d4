// A TOML table read key by key: wrong types, missing keys and keys that nobody asked for become errors that name file, line and key.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <toml++/toml.h>

#include "scene.h"
#include "vector.h"

namespace runner {

class TomlTable {
public:
  // `name` is how messages call the table, such as "world" or "emitters[0].region".
  TomlTable(const toml::table &table, const std::filesystem::path &file, std::string name);

  // Each sets `value` if the key is there and leaves it alone otherwise.
  void read(std::string_view key, float &value);
  void read(std::string_view key, double &value);
  void read(std::string_view key, std::uint32_t &value);
  void read(std::string_view key, std::uint64_t &value);
  void read(std::string_view key, int &value);
  void read(std::string_view key, bool &value);
  void read(std::string_view key, std::string &value);
  void read(std::string_view key, Vector3 &value);
  void read(std::string_view key, std::vector<std::string> &value);
  // The key's text must be one of the choices' names.
  template <class T> void read(std::string_view key, T &value, const std::vector<std::pair<std::string_view, T>> &choices);

  // Sub-tables and arrays of tables; nothing or an empty list if the key is not there.
  std::optional<TomlTable> table(std::string_view key);
  std::vector<TomlTable> tables(std::string_view key);

  bool has(std::string_view key) const;
  // Throws unless the key is there.
  void require(std::string_view key) const;
  // Throws if the table holds a key that has not been asked for. To be called when all keys have been read.
  void finish() const;

  Place place() const;
  // Throws Error about a key of this table.
  [[noreturn]] void fail(std::string_view key, const std::string &what) const;

private:
  const toml::node *find(std::string_view key);
  double number(const toml::node &node, std::string_view key) const;
  float single(const toml::node &node, std::string_view key) const;
  std::int64_t integer(const toml::node &node, std::string_view key, std::int64_t least, std::int64_t most) const;
  const std::string &text(const toml::node &node, std::string_view key) const;
  [[noreturn]] void fail_choice(std::string_view key, const std::string &given,
                                const std::vector<std::string_view> &names) const;

  const toml::table *table_;
  const std::filesystem::path *file_;
  std::string name_;
  std::vector<std::string> known_;
};

template <class T>
void TomlTable::read(std::string_view key, T &value, const std::vector<std::pair<std::string_view, T>> &choices) {
  const toml::node *node = find(key);
  if (node == nullptr) return;
  const std::string &given = text(*node, key);
  std::vector<std::string_view> names;
  for (const auto &[name, meaning] : choices) {
    if (name == given) {
      value = meaning;
      return;
    }
    names.push_back(name);
  }
  fail_choice(key, given, names);
}

} // namespace runner
