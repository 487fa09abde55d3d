// The pressure equation, integrated over the cells,
//
//   sum over faces of a c A/h (p - p_neighbour) = -(1 - alpha) V (eps_new - eps_old)/dt
//                                                 + swept - sum of a eps u* A outwards,
//   c = eps dt / (rho (1 + K)),     K = dt B / (eps rho)      (or with felt_gradient.cpp),
//
// swept: what moving bodies leave to the cell (moving_walls.cpp),
// with a half cell between the last cell and an outlet. Drag is part of c as well as of u*: with
// drag in u* alone the pressure drop of a bed would be short by 1/(1 + K).
//
// Regions without an outlet: projection_regions.cpp.
#include "cfd/projection.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <type_traits>

#include "cfd/halo_exchange.hpp"
#include "cfd/solve_failure.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

namespace {

// 1 / (rho (1 + K)) * dt = dt / (rho + dt B / eps), the velocity that a unit gradient removes.
struct WithGrains {
  const double* eps;
  const double* b;
  double density, dt;
  double void_fraction(std::ptrdiff_t n) const { return eps[n]; }
  double mobility(std::ptrdiff_t n) const { return dt / (density + dt * b[n] / eps[n]); }
};

struct WithoutGrains {
  double density, dt;
  double void_fraction(std::ptrdiff_t) const { return 1.0; }
  double mobility(std::ptrdiff_t) const { return dt / density; }
};

// The same with volume forcing, denser inside bodies: 1 becomes s (volume_forcing.cpp).
struct ScaledWithGrains : WithGrains {
  const double* scale;
  double mobility(std::ptrdiff_t n) const { return dt / (density * scale[n] + dt * b[n] / eps[n]); }
};

struct ScaledWithoutGrains : WithoutGrains {
  const double* scale;
  double mobility(std::ptrdiff_t n) const { return dt / (density * scale[n]); }
};

// The same where grains share in the pressure gradient by other than 1 - eps, felt_gradient.cpp.
template <class Faces>
struct SharedApart : Faces {
  const double* sharing_void_fraction;
  double lag;
  double mobility(std::ptrdiff_t n) const {
    const double of_gas = 1.0 - pressure_share(lag, sharing_void_fraction[n]).now;
    return of_gas / Faces::void_fraction(n) * Faces::mobility(n);
  }
};

// Calls visit with what the faces of a direction are filled with.
template <class Visit>
void with_faces(const FaceMedium& medium, double density, double dt, int d, const Visit& visit) {
  const WithGrains grains{medium.void_fraction[d].data(), medium.momentum_exchange[d].data(),
                          density, dt};
  const WithoutGrains gas{density, dt};
  const double* scale = medium.density_scaling[d].data();
  const auto visit_grains = [&](const auto& faces) {
    using Faces = std::remove_cvref_t<decltype(faces)>;
    if (!medium.shares_apart()) return visit(faces);
    visit(SharedApart<Faces>{faces, medium.sharing_void_fraction()[d].data(), medium.lag});
  };
  if (medium.has_scaling) {
    medium.has_grains ? visit_grains(ScaledWithGrains{grains, scale})
                      : visit(ScaledWithoutGrains{gas, scale});
  } else {
    medium.has_grains ? visit_grains(grains) : visit(gas);
  }
}

}  // namespace

Projection::Projection(const GasDomain& domain, const Numerics& numerics)
    : domain_(domain),
      tolerance_(numerics.pressure_tolerance),
      max_iterations_(numerics.pressure_iterations),
      reference_(numerics.reference_pressure),
      solver_(make_pressure_solver(domain.decomposition, numerics.pressure_solver,
                                   numerics.pressure_fallback)),
      term_norm_(domain.size()),
      divergence_(domain.size()) {
  system_.diagonal = system_.right_hand_side = Field(domain.size());
  for (int d = 0; d < 3; ++d) gradient_[d] = system_.transmissibility[d] = Field(domain.size());
  find_regions();
  system_.regions = &regions_;
}

void Projection::set_coefficients(const FaceMedium& medium, double dt) {
  for (const OutletTerm& term : outlet_terms_) system_.diagonal[term.cell] = 0.0;
  outlet_terms_.clear();
  for (int d = 0; d < 3; ++d) {
    with_faces(medium, domain_.gas.density, dt, d,
               [&](const auto& faces) { set_coefficients_along(d, faces); });
  }
  fill_ghosts(domain_.decomposition, system_.transmissibility);
}

template <class Faces>
void Projection::set_coefficients_along(int d, const Faces& faces) {
  Field& transmissibility = system_.transmissibility[d];
  double* t = transmissibility.data();
  const double* part = domain_.walls.takes_part[d].data();
  const double* open = domain_.walls.open_area[d].data();
  const double scale = domain_.face_area(d) / domain_.spacing[d];
  const auto coefficient = [=](std::ptrdiff_t n) {
    return part[n] * scale * open[n] * faces.void_fraction(n) * faces.mobility(n);
  };
  if (domain_.decomposition.grid().cells[d] > 1) {
    for_box(inner_faces(domain_, d), transmissibility,
            [=](std::ptrdiff_t n) { t[n] = coefficient(n); });
  }
  for (int side = 0; side < 2; ++side) {
    for_each_outlet_face(domain_, d, side,
                         [&](auto cell, auto face, const SideCondition& condition) {
                           const double to_outlet = 2.0 * coefficient(face);
                           system_.diagonal[cell] += to_outlet;
                           outlet_terms_.push_back({cell, to_outlet * condition.pressure});
                         });
  }
}

// The right-hand side without the outlets' pressures; with its terms' magnitudes when the sum over
// a region without outlet is to be judged.
void Projection::set_right_hand_side(const FaceMedium& medium, const Field* old_void_fraction,
                                     const VectorField& velocity, double dt) {
  double* rhs = system_.right_hand_side.data();
  double* norm = term_norm_.data();
  const double* eps = medium.cell_void_fraction.data();
  const double* open = domain_.open_share.data();
  const double* swept = domain_.has_motion ? swept_.data() : nullptr;
  const bool judged = regions_.any_singular();
  for_each_row({{0, 0, 0}, domain_.size()}, term_norm_, [&](std::ptrdiff_t row, int length) {
    if (old_void_fraction) {
      const double* old = old_void_fraction->data();
      const double scale = domain_.cell_volume() / dt;
      for_row(row, length,
              [=](std::ptrdiff_t n) { rhs[n] = -scale * open[n] * (eps[n] - old[n]); });
    } else {
      for_row(row, length, [=](std::ptrdiff_t n) { rhs[n] = 0.0; });
    }
    if (swept) for_row(row, length, [=](std::ptrdiff_t n) { rhs[n] += swept[n]; });
    if (judged) for_row(row, length, [=](std::ptrdiff_t n) { norm[n] = std::abs(rhs[n]); });
    for (int d = 0; d < 3; ++d) {
      with_faces(medium, domain_.gas.density, dt, d, [&](const auto& faces) {
        const double* open_area = domain_.walls.open_area[d].data();
        const double* u = velocity[d].data();
        const double area = domain_.face_area(d);
        const std::ptrdiff_t s = velocity[d].stride(d);
        const auto flux = [=](std::ptrdiff_t n) {
          return area * open_area[n] * faces.void_fraction(n) * u[n];
        };
        for_row(row, length, [=](std::ptrdiff_t n) { rhs[n] += flux(n) - flux(n + s); });
        if (!judged) return;
        for_row(row, length,
                [=](std::ptrdiff_t n) { norm[n] += std::abs(flux(n)) + std::abs(flux(n + s)); });
      });
    }
  });
  for (const std::ptrdiff_t cell : closed_cells_) rhs[cell] = norm[cell] = 0.0;
}

void Projection::add_outlets() {
  for (const OutletTerm& term : outlet_terms_) system_.right_hand_side[term.cell] += term.value;
}

void Projection::check(const PressureReport& report) const {
  if (report.converged) return;
  std::ostringstream message;
  message << "the pressure equation is not solved: residual " << report.residual << " after "
          << report.iterations << " iterations, numerics.pressure_tolerance is " << tolerance_
          << (report.fallbacks > 0 ? ", the fallback's included" : "")
          << "; raise numerics.pressure_iterations (now " << max_iterations_
          << "), take a smaller step or allow a larger residual";
  throw SolveFailure(message.str());
}

// follow(d, part) for parts of the faces of every direction as soon as their gradient is set.
template <class Follow>
void Projection::set_gradient(const Field& pressure, const Follow& follow) {
  for (int d = 0; d < 3; ++d) {
    Field& gradient = gradient_[d];
    const Field& part = domain_.walls.takes_part[d];
    const double scale = 1.0 / domain_.spacing[d];
    for (int side = 0; side < 2; ++side) {
      const double outwards = side == 0 ? -1.0 : 1.0;
      for_each_outlet_face(domain_, d, side,
                           [&](auto cell, auto face, const SideCondition& condition) {
                             const double rise = outwards * (condition.pressure - pressure[cell]);
                             gradient[face] = part[face] * 2.0 * scale * rise;
                           });
    }
    for_each_part(all_faces(domain_, d), [&](const IndexBox& faces) {
      for_box(
          intersection(faces, inner_faces(domain_, d)), pressure,
          [s = pressure.stride(d), scale, p = pressure.data(), open = part.data(),
           g = gradient.data()](std::ptrdiff_t n) { g[n] = open[n] * scale * (p[n] - p[n - s]); });
      follow(d, faces);
    });
  }
  fill_ghosts(domain_.decomposition, gradient_);
}

void Projection::set_gradient(const Field& pressure) {
  set_gradient(pressure, [](int, const IndexBox&) {});
}

void Projection::follow_walls(const Field& pressure, const VectorField& took_part) {
  find_regions();
  set_gradient(pressure);
  for (int d = 0; d < 3; ++d) {
    for (std::size_t n = 0; n < gradient_[d].count(); ++n) gradient_[d][n] *= took_part[d][n];
  }
}

Projection::Balance Projection::set_equation(const FaceMedium& medium,
                                             const Field* old_void_fraction,
                                             const VectorField& velocity, double dt) {
  Balance balance;
  set_coefficients(medium, dt);
  balance.swept_imbalance = balance_swept_volume();
  set_right_hand_side(medium, old_void_fraction, velocity, dt);
  balance.removed_mean = remove_means(dt);
  add_outlets();
  return balance;
}

PressureReport Projection::solve(Field& pressure) {
  if (reference_ != 0.0) set_pressure_means(pressure, 0.0);  // what the solver expects
  const PressureReport report = solver_->solve(system_, tolerance_, max_iterations_, pressure);
  check(report);
  return report;
}

double Projection::correct(VectorField& velocity, Field& pressure, const FaceMedium& medium,
                           double dt) {
  set_pressure_means(pressure, reference_);
  double magnitudes = 0.0;
  set_gradient(pressure, [&](int d, const IndexBox& part) {
    if (!domain_.solved[d]) return;
    with_faces(medium, domain_.gas.density, dt, d, [&](const auto& faces) {
      magnitudes +=
          sum_box(part, velocity[d],
                  [faces, u = velocity[d].data(), g = gradient_[d].data()](std::ptrdiff_t n) {
                    u[n] -= faces.mobility(n) * g[n];
                    return std::abs(u[n]);
                  });
    });
  });
  return magnitudes;
}

double Projection::divergence(const FaceMedium& medium, const Field* old_void_fraction,
                              const VectorField& velocity, double dt) {
  const double* open = domain_.open_share.data();
  const double* eps = medium.cell_void_fraction.data();
  const double* swept = domain_.has_motion ? swept_.data() : nullptr;
  double* change = divergence_.data();
  double largest = 0.0;
  auto closed = closed_cells_.begin();  // in the order of the rows
  for_each_row({{0, 0, 0}, domain_.size()}, divergence_, [&](std::ptrdiff_t row, int length) {
    if (old_void_fraction) {
      const double* old = old_void_fraction->data();
      for_row(row, length, [=](std::ptrdiff_t n) { change[n] = open[n] * (eps[n] - old[n]); });
    } else {
      for_row(row, length, [=](std::ptrdiff_t n) { change[n] = 0.0; });
    }
    if (swept) {
      const double scale = dt / domain_.cell_volume();
      for_row(row, length, [=](std::ptrdiff_t n) { change[n] -= scale * swept[n]; });
    }
    for (int d = 0; d < 3; ++d) {
      with_faces(medium, domain_.gas.density, dt, d, [&](const auto& faces) {
        const double* area = domain_.walls.open_area[d].data();
        const double* u = velocity[d].data();
        const double scale = dt / domain_.spacing[d];
        const std::ptrdiff_t s = velocity[d].stride(d);
        const auto flux = [=](std::ptrdiff_t n) { return area[n] * faces.void_fraction(n) * u[n]; };
        for_row(row, length,
                [=](std::ptrdiff_t n) { change[n] += scale * (flux(n + s) - flux(n)); });
      });
    }
    for (; closed != closed_cells_.end() && *closed < row + length; ++closed) change[*closed] = 0.0;
    if (domain_.walls.spans_bodies) {  // gas fills the solid part of a cell too
      largest = std::max(largest, max_row(row, length, [=](std::ptrdiff_t n) {
                           return std::abs(change[n]) / eps[n];
                         }));
      return;
    }
    largest = std::max(largest, max_row(row, length, [=](std::ptrdiff_t n) {
                         return change[n] != 0.0 ? std::abs(change[n]) / (open[n] * eps[n]) : 0.0;
                       }));
  });
  return max_over_ranks(domain_.decomposition, largest);
}

}  // namespace gasgrain::cfd
