// PNG with 8 bits per colour in a zlib stream of stored (not compressed) blocks: RFC 1950, 1951 and
// the PNG specification, second edition. Pictures are small; no library is needed.
#include "coupling/files/slice_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>

#include "coupling/shared/error.hpp"

namespace gasgrain {

namespace {

using Colour = std::array<unsigned char, 3>;

constexpr Colour black{0, 0, 0}, solid_far{120, 110, 100}, solid_near{170, 160, 150},
    flow_far{255, 255, 255}, flow_near{120, 170, 220};

Colour mix(const Colour& a, const Colour& b, double share_of_b) {
  Colour result;
  for (int n = 0; n < 3; ++n)
    result[n] = static_cast<unsigned char>(std::lround(a[n] + share_of_b * (b[n] - a[n])));
  return result;
}

Colour colour(double phi, double band, double pixel) {
  if (std::abs(phi) < 0.7 * pixel) return black;
  const double depth = std::min(1.0, std::abs(phi) / band);
  return phi < 0 ? mix(solid_near, solid_far, depth) : mix(flow_near, flow_far, depth);
}

void append(std::string& bytes, std::uint32_t value) {  // big endian
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xff);
}

std::uint32_t crc(const std::string& bytes) {
  std::uint32_t sum = 0xffffffffu;
  for (const char byte : bytes) {
    sum ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) sum = (sum & 1) ? sum >> 1 ^ 0xedb88320u : sum >> 1;
  }
  return ~sum;
}

std::uint32_t adler(const std::string& bytes) {
  constexpr std::uint32_t prime = 65521;
  std::uint32_t a = 1, b = 0;
  for (const char byte : bytes) {
    a = (a + static_cast<unsigned char>(byte)) % prime;
    b = (b + a) % prime;
  }
  return b << 16 | a;
}

std::string chunk(const std::string& type, const std::string& content) {
  std::string bytes;
  append(bytes, static_cast<std::uint32_t>(content.size()));
  const std::string checked = type + content;
  bytes += checked;
  append(bytes, crc(checked));
  return bytes;
}

std::string stored_stream(const std::string& bytes) {
  constexpr std::size_t most = 65535;
  std::string stream = "\x78\x01";
  for (std::size_t at = 0; at < bytes.size(); at += most) {
    const std::size_t size = std::min(most, bytes.size() - at);
    stream += at + size == bytes.size() ? '\1' : '\0';
    for (const std::size_t word : {size, ~size})
      for (const int shift : {0, 8}) stream += static_cast<char>(word >> shift & 0xff);
    stream.append(bytes, at, size);
  }
  append(stream, adler(bytes));
  return stream;
}

}  // namespace

void write_slice_picture(const std::string& path, const SampledDistance& field, const Slice& slice,
                         int pixels) {
  GASGRAIN_ASSERT(slice.axis >= 0 && slice.axis < 3 && pixels > 0);
  const int u = slice.axis == 0 ? 1 : 0, v = slice.axis == 2 ? 1 : 2;
  const Vec3 size = field.upper() - field.lower();
  const double pixel = std::max(size[u], size[v]) / pixels;
  const int columns = std::max(1, static_cast<int>(size[u] / pixel)),
            rows = std::max(1, static_cast<int>(size[v] / pixel));
  std::string lines;
  Vec3 x;
  x[slice.axis] = slice.position;
  for (int row = rows - 1; row >= 0; --row) {
    lines += '\0';  // no filter
    x[v] = field.lower()[v] + (row + 0.5) * pixel;
    for (int column = 0; column < columns; ++column) {
      x[u] = field.lower()[u] + (column + 0.5) * pixel;
      const Colour c = colour(field.distance(x), field.data().band, pixel);
      lines.append(c.begin(), c.end());
    }
  }
  std::string header;
  append(header, static_cast<std::uint32_t>(columns));
  append(header, static_cast<std::uint32_t>(rows));
  header += std::string("\x08\x02\0\0\0", 5);  // 8 bits, red green blue
  std::ofstream file(path, std::ios::binary);
  file << "\x89PNG\r\n\x1a\n"
       << chunk("IHDR", header) << chunk("IDAT", stored_stream(lines)) << chunk("IEND", "");
  if (!file.flush()) {
    throw UserError("cannot write picture '" + path +
                    "'; check that the directory exists, is writable and the disk is not full");
  }
}

}  // namespace gasgrain
