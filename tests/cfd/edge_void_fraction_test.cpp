#include "cfd/edge_void_fraction.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/cfd/gas_fixture.hpp"

namespace gasgrain::cfd {
namespace {

TEST(VoidFractionOnSide, stays_between_nothing_and_everything) {
  for (const double first : {1e-3, 0.2, 0.5, 0.9, 1.0}) {
    for (const double second : {1e-3, 0.2, 0.5, 0.9, 1.0}) {
      const double on_side = void_fraction_on_side(first, second);
      EXPECT_GT(on_side, 0.0);
      EXPECT_LE(on_side, 1.0);
      EXPECT_GE((on_side - first) * (first - second), 0.0) << first << " " << second;
    }
  }
}

TEST(VoidFractionOnSide, extrapolates_to_second_order) {
  for (const double slope : {-0.3, 0.3}) {
    const auto error = [&](double h) {
      return std::abs(void_fraction_on_side(0.5 + 0.5 * slope * h, 0.5 + 1.5 * slope * h) - 0.5);
    };
    EXPECT_LT(error(0.1), 1e-3);
    EXPECT_NEAR(error(0.2) / error(0.1), 4.0, 0.3);
  }
}

// eps = 0.4 + 0.3 x + 0.2 z in the unit square, cells of one eighth.
TEST(EdgeVoidFraction, is_that_of_the_place_inside_and_on_the_sides) {
  GasCase c = testing::box_case(Vec3(1, 0.125, 1), {8, 1, 8});
  testing::set_sides(c, 1, BoundaryType::slip);
  const GasDomain domain(c, MPI_COMM_WORLD);
  const Index3& size = domain.size();
  Field eps(size);
  for_each_in({{-1, -1, -1}, {size[0] + 1, size[1] + 1, size[2] + 1}}, [&](int i, int j, int k) {
    const Vec3 x = testing::cell_centre(domain.decomposition, i, j, k);
    eps(i, j, k) = 0.4 + 0.3 * x[0] + 0.2 * x[2];
  });
  EdgeVoidFraction edges = make_edge_void_fraction(domain);
  update(edges, domain, eps);
  const std::ptrdiff_t a = eps.stride(0), b = eps.stride(2);
  for_each_cell({size[0] + 1, 1, size[2] + 1}, [&](int i, int j, int k) {
    const std::ptrdiff_t n = eps.index(i, j, k);
    const auto around = [&](const Field& f) { return f[n] + f[n - a] + f[n - b] + f[n - a - b]; };
    const Vec3 x = testing::cell_centre(domain.decomposition, i, j, k);
    const double exact = 0.4 + 0.3 * (x[0] - 0.0625) + 0.2 * (x[2] - 0.0625);
    const int global[2] = {i + domain.decomposition.block().lower[0],
                           k + domain.decomposition.block().lower[2]};
    const bool in_corner = global[0] % 8 == 0 && global[1] % 8 == 0;
    if (in_corner) return;
    EXPECT_NEAR(around(edges.gas) / around(edges.share), exact, 3e-3);
  });
}

}  // namespace
}  // namespace gasgrain::cfd
