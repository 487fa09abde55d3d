#include "coupling/shared/config_table.hpp"

#include <toml++/toml.h>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "coupling/shared/error.hpp"

namespace gasgrain {

namespace {

std::string value_text(const toml::node& node) {
  if (const toml::array* array = node.as_array()) {
    std::string list;
    for (const toml::node& item : *array) list += (list.empty() ? "" : ", ") + value_text(item);
    return "[" + list + "]";
  }
  if (node.is_number()) {
    std::array<char, 32> number{};
    return {number.data(), std::to_chars(number.begin(), number.end(), *node.value<double>()).ptr};
  }
  if (node.is_boolean()) return *node.value<bool>() ? "true" : "false";
  if (node.is_string()) return '"' + *node.value<std::string>() + '"';
  std::ostringstream out;  // dates and times
  node.visit([&](const auto& value) { out << value; });
  return out.str();
}

// "is 1.2, but must be": how a complaint about a value of the wrong kind begins.
std::string instead_of(const toml::node& node) {
  return "is " + (node.is_table() ? "a table" : value_text(node)) + ", but must be ";
}

bool holds_tables(const toml::array& array) {
  return !array.empty() && array.front().is_table();
}

void add_statements(std::vector<ConfigStatement>& statements, const toml::node& node,
                    const std::string& key) {
  if (const toml::table* table = node.as_table()) {
    for (const auto& [name, value] : *table) {
      add_statements(statements, value, key + (key.empty() ? "" : ".") + std::string(name.str()));
    }
  } else if (const toml::array* array = node.as_array(); array && holds_tables(*array)) {
    for (std::size_t n = 0; n < array->size(); ++n) {
      add_statements(statements, (*array)[n], key + "[" + std::to_string(n + 1) + "]");
    }
  } else {
    statements.push_back({key, value_text(node)});
  }
}

}  // namespace

struct ConfigTable::Document {
  std::string file;
  toml::table root;
};

struct ConfigTable::Node {
  std::shared_ptr<const Document> document;
  const toml::table* table = nullptr;  // null: an absent table
  std::string path;                    // "grid." or ""
  std::set<std::string> known;         // keys that were asked for

  const toml::node* find(const std::string& key) {
    known.insert(key);
    return table ? table->get(key) : nullptr;
  }
};

ConfigTable::ConfigTable(std::shared_ptr<Node> node) : node_(std::move(node)) {}
ConfigTable::ConfigTable(const ConfigTable&) = default;
ConfigTable& ConfigTable::operator=(const ConfigTable&) = default;
ConfigTable::ConfigTable(ConfigTable&&) noexcept = default;
ConfigTable& ConfigTable::operator=(ConfigTable&&) noexcept = default;
ConfigTable::~ConfigTable() = default;

ConfigTable ConfigTable::parse(const std::string& text, const std::string& file) {
  auto document = std::make_shared<Document>();
  document->file = file;
  try {
    document->root = toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    std::ostringstream message;
    message << file << ":" << error.source().begin.line
            << ": not valid TOML: " << error.description();
    throw UserError(message.str());
  }
  auto node = std::make_shared<Node>();
  node->table = &document->root;
  node->document = std::move(document);
  return ConfigTable(node);
}

ConfigTable ConfigTable::parse_file(const std::string& file) {
  std::ifstream in(file);
  std::ostringstream text;
  if (in) text << in.rdbuf();
  if (!in || std::filesystem::is_directory(file)) {
    throw UserError("cannot read case file '" + file +
                    "'; check the path (relative to the directory the program was started in)");
  }
  return parse(text.str(), file);
}

const std::string& ConfigTable::file() const {
  return node_->document->file;
}

std::string ConfigTable::where(const std::string& key) const {
  std::ostringstream out;
  out << file();
  const toml::node* value = node_->table ? node_->table->get(key) : nullptr;
  const auto line = value          ? value->source().begin.line
                    : node_->table ? node_->table->source().begin.line
                                   : 0;
  if (line > 0) out << ":" << line;
  out << ": " << node_->path << key;
  return out.str();
}

bool ConfigTable::has(const std::string& key) const {
  return node_->find(key) != nullptr;
}

bool ConfigTable::is_list(const std::string& key) const {
  const toml::node* value = node_->find(key);
  return value && value->is_array();
}

double ConfigTable::number(const std::string& key, const Range& allowed) const {
  const toml::node* value = node_->find(key);
  if (!value) fail(key, "is missing; give a number in " + allowed.text());
  const auto number = value->value<double>();
  if (!number || value->is_boolean())
    fail(key, instead_of(*value) + "a number in " + allowed.text());
  if (!allowed.contains(*number)) {
    std::ostringstream message;
    message << "is " << *number << ", but must be in " << allowed.text();
    fail(key, message.str());
  }
  return *number;
}

long ConfigTable::integer(const std::string& key, const Range& allowed) const {
  const toml::node* value = node_->find(key);
  if (!value) fail(key, "is missing; give an integer in " + allowed.text());
  if (!value->is_integer()) fail(key, instead_of(*value) + "an integer in " + allowed.text());
  return std::lround(number(key, allowed));
}

bool ConfigTable::flag_or(const std::string& key, bool otherwise) const {
  const toml::node* value = node_->find(key);
  if (!value) return otherwise;
  if (!value->is_boolean()) fail(key, instead_of(*value) + "true or false");
  return *value->value<bool>();
}

std::string ConfigTable::text(const std::string& key) const {
  const toml::node* value = node_->find(key);
  if (!value) fail(key, "is missing; give a string");
  if (!value->is_string()) fail(key, instead_of(*value) + "a string in quotes");
  return *value->value<std::string>();
}

std::vector<double> ConfigTable::numbers(const std::string& key) const {
  const toml::node* value = node_->find(key);
  if (!value) fail(key, "is missing; give a list of numbers, such as [0, 0, 1]");
  const toml::array* array = value->as_array();
  if (!array) fail(key, instead_of(*value) + "a list of numbers, such as [0, 0, 1]");
  std::vector<double> result;
  for (const toml::node& item : *array) {
    const auto number = item.value<double>();
    if (!number || item.is_boolean() || !std::isfinite(*number)) {
      fail(key, "holds " + value_text(item) + ", but must hold finite numbers only");
    }
    result.push_back(*number);
  }
  return result;
}

std::vector<std::string> ConfigTable::texts(const std::string& key) const {
  const toml::node* value = node_->find(key);
  if (!value) fail(key, "is missing; give a list of strings");
  const toml::array* array = value->as_array();
  if (!array) fail(key, instead_of(*value) + "a list of strings");
  std::vector<std::string> result;
  for (const toml::node& item : *array) {
    if (!item.is_string()) fail(key, "holds " + value_text(item) + ", but must hold strings only");
    result.push_back(*item.value<std::string>());
  }
  return result;
}

ConfigTable ConfigTable::table_or_empty(const std::string& key) const {
  const toml::node* value = node_->find(key);
  if (value && !value->is_table())
    fail(key, instead_of(*value) + "a table: [" + node_->path + key + "]");
  auto node = std::make_shared<Node>();
  node->document = node_->document;
  node->table = value ? value->as_table() : nullptr;
  node->path = node_->path + key + ".";
  return ConfigTable(node);
}

ConfigTable ConfigTable::table(const std::string& key) const {
  if (!has(key)) fail(key, "is missing; add a table [" + node_->path + key + "]");
  return table_or_empty(key);
}

std::vector<ConfigTable> ConfigTable::tables(const std::string& key) const {
  const toml::node* value = node_->find(key);
  if (!value) return {};
  const toml::array* array = value->as_array();
  const std::string expected = "a list of tables: [[" + node_->path + key + "]]";
  if (!array) fail(key, instead_of(*value) + expected);
  std::vector<ConfigTable> result;
  for (const toml::node& item : *array) {
    if (!item.is_table()) fail(key, instead_of(*value) + expected);
    auto node = std::make_shared<Node>();
    node->document = node_->document;
    node->table = item.as_table();
    node->path = node_->path + key + "[" + std::to_string(result.size() + 1) + "].";
    result.push_back(ConfigTable(node));
  }
  return result;
}

std::vector<std::string> ConfigTable::keys() const {
  std::vector<std::string> result;
  if (node_->table) {
    for (const auto& [key, value] : *node_->table) result.emplace_back(key.str());
  }
  return result;
}

std::vector<ConfigStatement> ConfigTable::statements() const {
  std::vector<ConfigStatement> result;
  const std::string path = node_->path.empty() ? "" : node_->path.substr(0, node_->path.size() - 1);
  if (node_->table) add_statements(result, *node_->table, path);
  return result;
}

void ConfigTable::reject_unknown_keys() const {
  for (const std::string& key : keys()) {
    if (node_->known.count(key)) continue;
    const std::vector<std::string> known(node_->known.begin(), node_->known.end());
    const std::string near = nearest_name(key, known.data(), known.data() + known.size());
    std::string list;
    for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
    fail(key, near.empty() ? "is not a known key; known here: " + list
                           : "is not a known key; did you mean '" + near + "'?");
  }
}

}  // namespace gasgrain
