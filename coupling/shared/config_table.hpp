// Typed, checked reading of a TOML case file. The only header through which the project reads TOML.
//
// Protocol: read every key a component knows, then call reject_unknown_keys(); a key nobody asked
// for is an error that suggests the nearest known one. Every error names file, line and key.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coupling/shared/vec3.hpp"

namespace gasgrain {

// Allowed values of a number; `lower_open` and `upper_open` exclude the ends.
struct Range {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool lower_open = false;
  bool upper_open = false;

  static Range positive() { return {.lower = 0, .lower_open = true}; }
  static Range non_negative() { return {.lower = 0}; }
  bool contains(double value) const;
  std::string text() const;  // "in (0, 1]"
};

// A key with its full path and its value as text: {"body[1].sphere.radius", "0.1"}.
struct ConfigStatement {
  std::string key;
  std::string value;

  bool operator==(const ConfigStatement&) const = default;
};

class ConfigTable {
 public:
  // Parses a TOML text; `file` is the name that error messages give. Throws UserError.
  static ConfigTable parse(const std::string& text, const std::string& file);
  // Reads and parses a file. Throws UserError when it is missing or unreadable.
  static ConfigTable parse_file(const std::string& file);

  // True when the key is present; marks it as known.
  bool has(const std::string& key) const;

  // True when the key is present and holds a list; marks it as known.
  bool is_list(const std::string& key) const;

  double number(const std::string& key, const Range& allowed = {}) const;
  double number_or(const std::string& key, double otherwise, const Range& allowed = {}) const;
  long integer(const std::string& key, const Range& allowed = {}) const;
  long integer_or(const std::string& key, long otherwise, const Range& allowed = {}) const;
  bool flag_or(const std::string& key, bool otherwise) const;
  std::string text(const std::string& key) const;
  std::string text_or(const std::string& key, const std::string& otherwise) const;
  // A string that must be one of `allowed`.
  std::string choice(const std::string& key, const std::vector<std::string>& allowed) const;
  std::string choice_or(const std::string& key, const std::string& otherwise,
                        const std::vector<std::string>& allowed) const;
  Vec3 vector(const std::string& key) const;
  Vec3 vector_or(const std::string& key, const Vec3& otherwise) const;
  std::array<int, 3> integers3(const std::string& key, const Range& allowed = {}) const;
  std::vector<double> numbers(const std::string& key) const;
  std::vector<std::string> texts(const std::string& key) const;

  // The sub-table at `key`; an error when it is absent or no table.
  ConfigTable table(const std::string& key) const;
  // The sub-table at `key`, or an empty one (whose keys are all absent).
  ConfigTable table_or_empty(const std::string& key) const;
  // The array of tables at `key`; empty when the key is absent.
  std::vector<ConfigTable> tables(const std::string& key) const;

  std::vector<std::string> keys() const;

  // All that the table and those below it say, ordered by key; 1 and 1.0 are the same text. Marks
  // nothing as known.
  std::vector<ConfigStatement> statements() const;

  // Throws UserError for the first key that was not asked for so far.
  void reject_unknown_keys() const;

  // "bed.toml:12: gas.density"; the prefix of every message about `key`.
  std::string where(const std::string& key) const;
  // Throws UserError "<where(key)>: <message>".
  [[noreturn]] void fail(const std::string& key, const std::string& message) const;
  // Name of the file the table came from; relative paths in it are relative to its directory.
  const std::string& file() const;
  // `path` as given in the case file, made relative to the case file's own directory.
  std::string resolve_path(const std::string& path) const;

  ConfigTable(const ConfigTable&);
  ConfigTable& operator=(const ConfigTable&);
  ConfigTable(ConfigTable&&) noexcept;
  ConfigTable& operator=(ConfigTable&&) noexcept;
  ~ConfigTable();

 private:
  struct Document;
  struct Node;
  explicit ConfigTable(std::shared_ptr<Node> node);
  std::shared_ptr<Node> node_;
};

}  // namespace gasgrain
