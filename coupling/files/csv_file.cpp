#include "coupling/files/csv_file.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "coupling/shared/error.hpp"

namespace gasgrain {

namespace {

std::string joined(const std::vector<std::string>& columns) {
  std::string line;
  for (const std::string& column : columns) line += (line.empty() ? "" : ",") + column;
  return line;
}

// Bytes of the file up to and with the last whole row not later than `time`; 0 without a file.
std::uintmax_t length_until(double time, const std::string& path, const std::string& header) {
  std::ifstream in(path, std::ios::binary);
  std::string line;
  if (!in || !std::getline(in, line)) return 0;
  if (line != header) {
    throw UserError("cannot continue '" + path +
                    "': its columns are not those of this case; give another output directory, or "
                    "move the file away");
  }
  std::uintmax_t length = line.size() + 1;
  while (std::getline(in, line) && !in.eof()) {  // a line without its end is no whole row
    if (std::strtod(line.c_str(), nullptr) > time) break;
    length += line.size() + 1;
  }
  return length;
}

}  // namespace

CsvFile::CsvFile(const std::string& path, const std::vector<std::string>& columns,
                 std::optional<double> continue_from)
    : path_(path), columns_(columns.size()) {
  const std::string header = joined(columns);
  const std::uintmax_t length = continue_from ? length_until(*continue_from, path, header) : 0;
  if (length > 0) {
    std::error_code error;
    std::filesystem::resize_file(path, length, error);
    if (error) throw UserError("cannot continue '" + path + "': " + error.message());
    out_.open(path, std::ios::binary | std::ios::app);
  } else {
    out_.open(path, std::ios::binary);
    out_ << header << '\n';
  }
  flush();
}

void CsvFile::add(std::span<const double> row) {
  GASGRAIN_ASSERT(row.size() == columns_);
  std::array<char, 32> number{};
  for (std::size_t n = 0; n < row.size(); ++n) {
    if (n > 0) out_ << ',';
    const double value = std::isnan(row[n]) ? std::abs(row[n]) : row[n];  // never "-nan"
    const auto end = std::to_chars(number.data(), number.data() + number.size(), value).ptr;
    out_.write(number.data(), end - number.data());
  }
  out_ << '\n';
}

void CsvFile::flush() {
  out_.flush();
  if (!out_) {
    throw UserError("cannot write '" + path_ +
                    "'; check that the output directory exists, is writable and the disk is not "
                    "full");
  }
}

}  // namespace gasgrain
