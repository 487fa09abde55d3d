// What passes a side between two control volumes is computed once for both: across x and y for a
// part of a plane that stays in the fastest cache, across z for a plane that serves the next one.
#include "cfd/momentum_slope.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "cfd/viscous_stress.hpp"

namespace gasgrain::cfd {

namespace {

// Convection of a component, of stride c, along a direction, of stride a.
template <class Scheme, class Flux>
struct Transport {
  Flux faces;
  const double* u;
  std::ptrdiff_t a, c;
  double scale;  // rho / h
  // Through the side between faces n - a and n; the mean of F at the two cells of the component's
  // face, or at the two faces when the transport is along the component itself.
  double flux(std::ptrdiff_t n) const { return 0.5 * (faces[n - c] + faces[n]); }
  double carried(double flux, std::ptrdiff_t n) const { return Scheme::carried(flux, u, n, a); }
};

struct NoTransport {};
struct NoStress {};

template <class Kernel>
constexpr bool present = !std::is_same_v<Kernel, NoTransport> && !std::is_same_v<Kernel, NoStress>;

// Sets the sides below the faces of `box`; work space index 0 is the storage index `origin`.
template <class Sides, class TransportOf, class Stress>
void set_sides(Sides& sides, const IndexBox& box, const Field& like, std::ptrdiff_t origin,
               const TransportOf& transport, const Stress& stress) {
  double* flux = sides.flux.data() - origin;
  double* carried = sides.carried.data() - origin;
  double* strain = sides.stress.data() - origin;
  for_each_row(box, like, [=](std::ptrdiff_t row, int length) {
    const TransportOf convection = transport;  // a copy that no store can change: its members stay
    const Stress friction = stress;            // in registers
#pragma omp simd
    for (std::ptrdiff_t n = row; n < row + length; ++n) {
      if constexpr (present<TransportOf>) {
        const double f = convection.flux(n);
        flux[n] = f;
        carried[n] = convection.carried(f, n);
      }
      if constexpr (present<Stress>) strain[n] = friction(n);
    }
  });
}

}  // namespace

SlopeEvaluation::SlopeEvaluation(const GasDomain& domain, Convection scheme)
    : domain_(domain), scheme_(scheme) {
  const std::ptrdiff_t plane = domain.open_share.stride(2);
  for (Sides* sides : {&near_, &below_, &above_}) {
    for (auto* values : {&sides->flux, &sides->carried, &sides->stress}) values->resize(plane);
  }
  carried_.resize(plane);
  shear_.resize(plane);
}

std::ptrdiff_t SlopeEvaluation::first_face(const IndexBox& box) const {
  return domain_.open_share.index(box.begin[0], box.begin[1], box.begin[2]);
}

template <class TransportOf, class Stress>
void SlopeEvaluation::add_change(const Part& part, int e, const TransportOf& transport,
                                 const Stress& stress) {
  const Field& like = domain_.open_share;
  const IndexBox all = all_faces(domain_, part.d);
  const IndexBox inner = e == part.d ? intersection(all, inner_faces(domain_, e)) : all;
  const IndexBox box = intersection(part.box, inner);
  if (box.begin[1] >= box.end[1] || box.begin[2] >= box.end[2]) return;
  const std::ptrdiff_t part_origin = first_face(part.box);
  const std::ptrdiff_t origin = e == 2 ? part.plane : part_origin;
  IndexBox sides = box;
  if (e == 2) {
    if (box.begin[2] == inner.begin[2]) set_sides(below_, box, like, origin, transport, stress);
    sides.begin[2] += 1;
  }
  sides.end[e] += 1;
  Sides& upper = e == 2 ? above_ : near_;
  set_sides(upper, sides, like, e == 2 ? origin + like.stride(2) : origin, transport, stress);

  const Sides& lower = e == 2 ? below_ : near_;
  const std::ptrdiff_t step = e == 2 ? 0 : like.stride(e);
  for_box(box, like,
          [=, low_flux = lower.flux.data() - origin, low_carried = lower.carried.data() - origin,
           low_stress = lower.stress.data() - origin, flux = upper.flux.data() - origin + step,
           value = upper.carried.data() - origin + step,
           strain = upper.stress.data() - origin + step, gain = carried_.data() - part_origin,
           shear = shear_.data() - part_origin](std::ptrdiff_t n) {
            if constexpr (present<TransportOf>) {
              const double u = transport.u[n];
              gain[n] -=
                  transport.scale * (flux[n] * (value[n] - u) - low_flux[n] * (low_carried[n] - u));
            }
            if constexpr (present<Stress>) shear[n] += strain[n] - low_stress[n];
          });
}

template <class Scheme>
void SlopeEvaluation::add_changes(const Part& part, const FaceMedium& medium,
                                  const VectorField& velocity) {
  const int d = part.d;
  for (int e = 0; e < 3; ++e) {
    if (!domain_.varies[e]) continue;
    const auto with_transport = [&](const auto& visit) {
      const bool carries = e == d || domain_.solved[e];
      if constexpr (std::is_same_v<Scheme, NoTransport>) {
        visit(NoTransport{});
      } else if (!carries) {
        visit(NoTransport{});
      } else {
        const Field& u = velocity[d];
        with_flux(medium, velocity, e, [&](const auto& flux) {
          visit(Transport<Scheme, std::decay_t<decltype(flux)>>{
              flux, u.data(), u.stride(e), u.stride(d), domain_.gas.density / domain_.spacing[e]});
        });
      }
    };
    with_transport([&](const auto& transport) {
      if (domain_.gas.viscosity == 0.0) {
        add_change(part, e, transport, NoStress{});
        return;
      }
      with_stress(domain_, medium, velocity, d, e,
                  [&](const auto& stress) { add_change(part, e, transport, stress); });
    });
  }
}

// From the work space to the slope and its integrals.
void SlopeEvaluation::finish(MomentumSlope& slope, const Part& part) const {
  const int d = part.d;
  const bool apart = slope.stress[d].count() > 0;
  const std::ptrdiff_t origin = first_face(part.box);
  const double* gain = carried_.data() - origin;
  const double* shear = shear_.data() - origin;
  const double* volume = domain_.control_volume[d].data();
  double* total = slope.total[d].data();
  double* stress = slope.stress[d].data();
  slope.convection[d] +=
      sum_box(part.box, slope.total[d], [=](std::ptrdiff_t n) { return volume[n] * gain[n]; });
  slope.viscous[d] += sum_box(part.box, slope.total[d], [=](std::ptrdiff_t n) {
    total[n] = apart ? gain[n] : gain[n] + shear[n];
    return volume[n] * shear[n];
  });
  if (apart) for_box(part.box, slope.total[d], [=](std::ptrdiff_t n) { stress[n] = shear[n]; });
}

void SlopeEvaluation::evaluate(MomentumSlope& slope, const FaceMedium& medium,
                               const VectorField& velocity) {
  slope.convection = slope.viscous = Vec3::Zero();
  for (int d = 0; d < 3; ++d) {
    if (!domain_.solved[d]) continue;
    const IndexBox all = all_faces(domain_, d);
    for (int k = all.begin[2]; k < all.end[2]; ++k) {
      IndexBox plane = all;
      plane.begin[2] = k;
      plane.end[2] = k + 1;
      for_each_part(plane, [&](const IndexBox& box) {
        const std::ptrdiff_t count = (box.end[1] - box.begin[1]) * domain_.open_share.stride(1);
        std::fill_n(carried_.begin(), count, 0.0);
        std::fill_n(shear_.begin(), count, 0.0);
        const Part part{d, box, first_face(plane)};
        switch (scheme_) {
          case Convection::none:
            add_changes<NoTransport>(part, medium, velocity);
            break;
          case Convection::central:
            add_changes<CentralValue>(part, medium, velocity);
            break;
          case Convection::van_leer:
            add_changes<VanLeerValue>(part, medium, velocity);
            break;
        }
        finish(slope, part);
      });
      std::swap(below_, above_);
    }
    slope.convection[d] +=
        add_convection_on_sides(slope.total[d], domain_, medium, velocity, scheme_, d);
  }
}

}  // namespace gasgrain::cfd
