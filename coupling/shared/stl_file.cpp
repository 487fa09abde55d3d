// STL: 80 bytes of text, a count, 50 bytes per triangle (normal, three corners, 2 bytes) in little
// endian; or words: facet normal n outer loop vertex a vertex b vertex c endloop endfacet.
//
// Binary files may begin with "solid" too, so the size decides: a file is binary when its count
// fits its size exactly. Memory is taken for triangles that are there, never for those a header
// claims.
#include "coupling/shared/stl_file.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string_view>

#include "coupling/shared/error.hpp"

namespace gasgrain {

namespace {

constexpr std::size_t header_bytes = 84, triangle_bytes = 50;

[[noreturn]] void fail(const std::string& name, const std::string& message) {
  throw UserError("STL file '" + name + "': " + message);
}

template <class T>
T little_endian(const char* bytes) {
  static_assert(std::endian::native == std::endian::little, "big-endian hosts need a byte swap");
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

std::vector<LooseTriangle> parse_binary(const std::string& bytes, std::size_t count,
                                        const std::string& name) {
  std::vector<LooseTriangle> triangles(count);
  for (std::size_t t = 0; t < count; ++t) {
    const char* corners = bytes.data() + header_bytes + t * triangle_bytes + 3 * sizeof(float);
    for (int n = 0; n < 9; ++n) {
      const double value = little_endian<float>(corners + n * sizeof(float));
      if (!std::isfinite(value))
        fail(name, "triangle " + std::to_string(t + 1) + " of " + std::to_string(count) +
                       " has a coordinate that is no finite number; export the file again");
      triangles[t][n / 3][n % 3] = value;
    }
  }
  return triangles;
}

// Words of a text with the line each stands in.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  // Lower case; empty at the end.
  std::string next() {
    while (at_ < text_.size() && is_space(text_[at_])) line_ += text_[at_++] == '\n';
    std::string word;
    while (at_ < text_.size() && !is_space(text_[at_])) {
      const char c = text_[at_++];
      word += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    return word;
  }
  void skip_line() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
  }
  std::size_t line() const { return line_; }

 private:
  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

  std::string_view text_;
  std::size_t at_ = 0, line_ = 1;
};

class TextReader {
 public:
  TextReader(const std::string& text, const std::string& name) : words_(text), name_(name) {}

  std::vector<LooseTriangle> read() {
    for (std::string word = words_.next(); !word.empty(); word = words_.next()) {
      if (word == "solid" || word == "endsolid")
        words_.skip_line();  // a name of any words
      else if (word == "facet")
        read_facet();
      else
        complain(word, "a facet or the end");
    }
    return std::move(triangles_);
  }

 private:
  [[noreturn]] void complain(const std::string& found, const char* expected) const {
    std::ostringstream message;
    message << "line " << words_.line() << ": "
            << (found.empty() ? "ends" : "has '" + found.substr(0, 20) + "'") << " where "
            << expected << " was expected; the file is damaged or no STL file";
    fail(name_, message.str());
  }
  void expect(const char* expected) {
    const std::string word = words_.next();
    if (word != expected) complain(word, expected);
  }
  double number() {
    const std::string word = words_.next();
    const char* begin = word.data() + (word.starts_with('+') ? 1 : 0);
    double value = 0.0;
    const auto [end, error] = std::from_chars(begin, word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
      complain(word, "a finite number");
    return value;
  }
  void read_facet() {
    expect("normal");
    for (int d = 0; d < 3; ++d) words_.next();  // some programs write nan here
    expect("outer");
    expect("loop");
    LooseTriangle triangle;
    for (Vec3& corner : triangle) {
      expect("vertex");
      for (int d = 0; d < 3; ++d) corner[d] = number();
    }
    expect("endloop");
    expect("endfacet");
    triangles_.push_back(triangle);
  }

  Words words_;
  const std::string& name_;
  std::vector<LooseTriangle> triangles_;
};

bool begins_as_text(const std::string& bytes) {
  std::istringstream words(bytes.substr(0, 200));
  std::string first;
  words >> first;
  return first == "solid" || first == "SOLID" || first == "Solid";
}

}  // namespace

std::vector<LooseTriangle> parse_stl(const std::string& bytes, const std::string& name) {
  if (bytes.empty()) fail(name, "is empty");
  std::size_t count = 0, needed = 0;
  const bool may_be_binary = bytes.size() >= header_bytes;
  if (may_be_binary) {
    count = little_endian<std::uint32_t>(bytes.data() + header_bytes - 4);
    needed = header_bytes + count * triangle_bytes;
  }
  std::vector<LooseTriangle> triangles;
  if (may_be_binary && needed == bytes.size()) {
    triangles = parse_binary(bytes, count, name);
  } else if (begins_as_text(bytes)) {
    triangles = TextReader(bytes, name).read();
  } else if (may_be_binary && needed < bytes.size()) {
    triangles = parse_binary(bytes, count, name);  // some programs append something
  } else if (may_be_binary) {
    fail(name, "claims " + std::to_string(count) + " triangles, which need " +
                   std::to_string(needed) + " bytes, but has " + std::to_string(bytes.size()) +
                   "; the file is cut short or no STL file");
  } else {
    fail(name, "is no STL file: " + std::to_string(bytes.size()) +
                   " bytes that do not begin with 'solid'");
  }
  if (triangles.empty()) fail(name, "has no triangles");
  return triangles;
}

std::vector<LooseTriangle> read_stl(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  if (!file || !(bytes << file.rdbuf()))
    throw UserError("cannot read STL file '" + path + "', or it is empty");
  return parse_stl(std::move(bytes).str(), path);
}

}  // namespace gasgrain
