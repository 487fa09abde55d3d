#include "coupling/files/summary.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "coupling/shared/error.hpp"

namespace gasgrain {

namespace {

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04x", c);
      result += code;
    } else {
      result += c;
    }
  }
  return result + '"';
}

// JSON has no infinity and no NaN.
std::string number(std::optional<double> value) {
  if (!value || !std::isfinite(*value)) return "null";
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", *value);
  return text;
}

}  // namespace

std::string summary_text(const Summary& summary) {
  std::string text = "{\n  \"case\": " + quoted(summary.case_name) +
                     ",\n  \"commit\": " + quoted(summary.commit) + ",\n  \"quantities\": [\n";
  for (std::size_t n = 0; n < summary.quantities.size(); ++n) {
    const Quantity& q = summary.quantities[n];
    text += "    {\"name\": " + quoted(q.name) + ", \"value\": " + number(q.value) +
            ", \"unit\": " + quoted(q.unit) + ", \"reference\": " + number(q.reference) +
            ", \"tolerance\": " + number(q.tolerance) + ", \"source\": " + quoted(q.source) + "}" +
            (n + 1 < summary.quantities.size() ? ",\n" : "\n");
  }
  return text + "  ]\n}\n";
}

void write_summary(const std::string& path, const Summary& summary) {
  const std::string temporary = path + ".part";
  std::ofstream out(temporary);
  out << summary_text(summary);
  out.close();
  std::error_code failure;
  if (out) std::filesystem::rename(temporary, path, failure);
  if (!out || failure) {
    throw UserError("cannot write '" + path +
                    "'; check that the directory exists, is writable and "
                    "that the disk is not full");
  }
}

std::string source_commit() {
  return GASGRAIN_COMMIT;
}

}  // namespace gasgrain
