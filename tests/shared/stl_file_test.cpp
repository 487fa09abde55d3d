#include "coupling/shared/stl_file.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <random>

#include "coupling/shared/error.hpp"
#include "tests/shared/mesh_fixture.hpp"

namespace gasgrain {
namespace {

void append(std::string& bytes, const void* value, std::size_t size) {
  bytes.append(static_cast<const char*>(value), size);
}

std::string binary_stl(const Triangles& triangles, std::uint32_t claimed) {
  std::string bytes = "solid of a program that writes so into binary files";
  bytes.resize(80, ' ');
  append(bytes, &claimed, sizeof claimed);
  for (const LooseTriangle& t : triangles) {
    bytes.append(12, '\0');
    for (const Vec3& corner : t) {
      const Eigen::Vector3f value = corner.cast<float>();
      append(bytes, value.data(), 12);
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

std::string binary_stl(const Triangles& triangles) {
  return binary_stl(triangles, static_cast<std::uint32_t>(triangles.size()));
}

std::string ascii_stl(const Triangles& triangles) {
  std::string text = "solid a name of several words facet\r\n";
  for (const LooseTriangle& t : triangles) {
    text += " FACET NORMAL nan nan nan\r\n  outer loop\r\n";
    for (const Vec3& c : t) {
      text += "   vertex ";
      for (int d = 0; d < 3; ++d) {
        if (c[d] >= 0) text += '+';
        text += std::to_string(c[d]);
        text += "e0 ";
      }
      text += "\r\n";
    }
    text += "  endloop\r\n endfacet\r\n";
  }
  return text + "endsolid a name of several words";
}

const Triangles box = box_triangles(Vec3(-1, 0, 2), Vec3(1.5, 0.25, 4));

std::string complaint(const std::string& bytes) {
  try {
    parse_stl(bytes, "x.stl");
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

TEST(StlFile, ReadsBinaryAndTextAlike) {
  EXPECT_EQ(parse_stl(binary_stl(box), "b"), box);
  EXPECT_EQ(parse_stl(ascii_stl(box), "t"), box);
  EXPECT_EQ(parse_stl(ascii_stl(box) + "\n" + ascii_stl(box), "two solids"), both(box, box));
}

TEST(StlFile, ToleratesBytesAfterTheTriangles) {
  std::string bytes = binary_stl(box) + "trailing";
  bytes.replace(0, 5, "model");
  EXPECT_EQ(parse_stl(bytes, "b"), box);
}

TEST(StlFile, NamesWhatIsWrong) {
  EXPECT_NE(complaint("").find("is empty"), std::string::npos);
  EXPECT_NE(complaint("PK\3\4").find("no STL file"), std::string::npos);
  std::string cut = binary_stl(box);
  cut.replace(0, 5, "model");
  cut.resize(cut.size() - 7);
  EXPECT_NE(complaint(cut).find("claims 12 triangles, which need 684 bytes, but has 677"),
            std::string::npos);
  std::string boast = binary_stl(box, 43'000'000);  // 2 GB
  boast.replace(0, 5, "model");
  EXPECT_NE(complaint(boast).find("cut short"), std::string::npos);
  EXPECT_NE(complaint(binary_stl({})).find("no triangles"), std::string::npos);
  EXPECT_NE(complaint("solid nothing\nendsolid").find("no triangles"), std::string::npos);
  EXPECT_NE(complaint("solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 x").find("line 4"),
            std::string::npos);
  EXPECT_NE(complaint("solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan").find("finite"),
            std::string::npos);
  EXPECT_NE(complaint("solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0").find("ends where"),
            std::string::npos);
  Triangles damaged = box;
  damaged[7][1][2] = std::numeric_limits<double>::infinity();
  EXPECT_NE(complaint(binary_stl(damaged)).find("triangle 8 of 12"), std::string::npos);
  EXPECT_THROW(read_stl("missing.stl"), UserError);
  EXPECT_THROW(read_stl("/"), UserError);
}

// Whatever bytes: triangles of finite numbers or a UserError, never anything else.
TEST(StlFile, SurvivesDamage) {
  std::mt19937 random{7};
  const auto below = [&](std::size_t n) { return random() % n; };
  int accepted = 0, refused = 0;
  for (int n = 0; n < 20000; ++n) {
    std::string bytes = n % 2 ? binary_stl(box) : ascii_stl(box);
    if (n % 5 == 0) bytes.resize(below(bytes.size() + 1));
    for (std::size_t k = below(4); k > 0 && !bytes.empty(); --k)
      bytes[below(bytes.size())] = static_cast<char>(random());
    if (n % 7 == 0 && bytes.size() > 84) {
      const std::uint32_t count = random();
      std::memcpy(bytes.data() + 80, &count, sizeof count);
    }
    try {
      for (const LooseTriangle& t : parse_stl(bytes, "fuzz"))
        for (const Vec3& corner : t) ASSERT_TRUE(corner.allFinite());
      ++accepted;
    } catch (const UserError&) {
      ++refused;
    }
  }
  EXPECT_GT(accepted, 1000);
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace gasgrain
