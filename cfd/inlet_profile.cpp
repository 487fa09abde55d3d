// The mean of a profile over a face is exact, not its value in the middle, so that the sum over the
// faces is the flux of the profile itself:
//
//   parabola  6 s (1 - s), s in [0, 1] over the extent of the inlet:  [3 s^2 - 2 s^3] / (s_b - s_a)
//   table     piecewise linear, a product of hat functions in two directions.
#include "cfd/inlet_profile.hpp"

#include <algorithm>
#include <sstream>

#include "cfd/csv_table.hpp"
#include "coupling/shared/error.hpp"
#include "coupling/shared/text.hpp"

namespace gasgrain::cfd {

namespace {

constexpr double round_off = 1e-9;  // of the extent
const std::array<std::string, 3> axes{"x", "y", "z"};

double mean_of_parabola(double lower, double upper, double a, double b) {
  const double length = upper - lower;
  const double s = (a - lower) / length, t = (b - lower) / length;
  return ((3.0 * t * t - 2.0 * t * t * t) - (3.0 * s * s - 2.0 * s * s * s)) / (t - s);
}

// Weight of each point's value in the mean of the linear interpolant over [a, b].
std::vector<double> hat_means(const std::vector<double>& points, double a, double b) {
  std::vector<double> weights(points.size(), 0.0);
  for (std::size_t n = 0; n + 1 < points.size(); ++n) {
    const double from = std::max(a, points[n]), to = std::min(b, points[n + 1]);
    if (to <= from) continue;
    const double share = (to - from) / (b - a);
    const double middle = (0.5 * (from + to) - points[n]) / (points[n + 1] - points[n]);
    weights[n] += share * (1.0 - middle);
    weights[n + 1] += share * middle;
  }
  return weights;
}

double mean_of_table(const InletProfile& profile, const Rectangle& face) {
  std::array<std::vector<double>, 3> weights;
  for (int d = 0; d < 3; ++d) {
    weights[d] = {1.0};
    if (profile.coordinates[d].empty()) continue;
    weights[d] = hat_means(profile.coordinates[d], face.lower[d], face.upper[d]);
  }
  double mean = 0.0;
  std::size_t n = 0;
  for (const double z : weights[2]) {
    for (const double y : weights[1]) {
      for (const double x : weights[0]) mean += x * y * z * profile.velocities[n++];
    }
  }
  return mean;
}

std::vector<double> distinct(const CsvTable& csv, int column) {
  std::vector<double> values;
  for (const std::vector<double>& row : csv.rows) values.push_back(row[column]);
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

// Position of a row in the lattice of the coordinates.
std::size_t place_of(const InletProfile& profile, const std::array<int, 3>& columns,
                     const std::vector<double>& row) {
  std::size_t place = 0, stride = 1;
  for (int d = 0; d < 3; ++d) {
    if (columns[d] < 0) continue;
    const std::vector<double>& points = profile.coordinates[d];
    place +=
        stride * (std::lower_bound(points.begin(), points.end(), row[columns[d]]) - points.begin());
    stride *= points.size();
  }
  return place;
}

void fill_lattice(InletProfile& profile, const CsvTable& csv, const std::array<int, 3>& columns,
                  const ConfigTable& table) {
  std::size_t points = 1;
  for (int d = 0; d < 3; ++d) points *= std::max<std::size_t>(profile.coordinates[d].size(), 1);
  std::vector<bool> seen(points, false);
  profile.velocities.assign(points, 0.0);
  for (const std::vector<double>& row : csv.rows) {
    const std::size_t place = place_of(profile, columns, row);
    const double velocity = row[csv.column("velocity")];
    if (velocity < 0.0) {
      table.fail("profile_file", "has a velocity of " + std::to_string(velocity) +
                                     " m/s; an inlet blows inwards, give values >= 0");
    }
    if (seen[place]) {
      std::string position;
      for (int d = 0; d < 3; ++d) {
        if (columns[d] < 0) continue;
        position +=
            (position.empty() ? "" : ", ") + axes[d] + " = " + text("%.6g m", row[columns[d]]);
      }
      table.fail("profile_file", "gives the position " + position + " twice; remove a row");
    }
    seen[place] = true;
    profile.velocities[place] = velocity;
  }
  if (csv.rows.size() != points) {
    table.fail("profile_file", "has " + std::to_string(csv.rows.size()) + " rows, but " +
                                   std::to_string(points) +
                                   " make the full lattice of its positions");
  }
}

InletProfile read_profile_file(const ConfigTable& table, int across) {
  InletProfile profile;
  profile.kind = ProfileKind::table;
  const CsvTable csv = read_csv(table.resolve_path(table.text("profile_file")));
  std::array<int, 3> columns{-1, -1, -1};
  std::size_t used = csv.column("velocity") >= 0 ? 1 : 0;
  for (int d = 0; d < 3; ++d) {
    if (d == across || csv.column(axes[d]) < 0) continue;
    columns[d] = csv.column(axes[d]);
    profile.coordinates[d] = distinct(csv, columns[d]);
    ++used;
    if (profile.coordinates[d].size() < 2) {
      table.fail("profile_file", "needs two or more positions in column '" + axes[d] + "'");
    }
  }
  if (csv.column("velocity") < 0 || used < 2 || used != csv.columns.size()) {
    table.fail("profile_file",
               "must have the column 'velocity' (m/s inwards) and one or both of '" +
                   axes[(across + 1) % 3] + "' and '" + axes[(across + 2) % 3] + "' (m)");
  }
  fill_lattice(profile, csv, columns, table);
  return profile;
}

}  // namespace

double mean_over_face(const InletProfile& profile, int across, const Rectangle& extent,
                      const Rectangle& face) {
  if (profile.kind == ProfileKind::uniform) return 1.0;
  if (profile.kind == ProfileKind::table) return mean_of_table(profile, face);
  double mean = 1.0;
  for (int d = 0; d < 3; ++d) {
    if (d == across || !profile.along[d]) continue;
    mean *= mean_of_parabola(extent.lower[d], extent.upper[d], face.lower[d], face.upper[d]);
  }
  return mean;
}

void check_coverage(const InletProfile& profile, const Rectangle& extent,
                    const std::string& where) {
  for (int d = 0; d < 3; ++d) {
    const std::vector<double>& points = profile.coordinates[d];
    if (points.empty()) continue;
    const double slack = round_off * (extent.upper[d] - extent.lower[d]);
    if (points.front() <= extent.lower[d] + slack && points.back() >= extent.upper[d] - slack) {
      continue;
    }
    std::ostringstream message;
    message << where << ": profile_file covers " << axes[d] << " from " << points.front() << " to "
            << points.back() << " m, but the inlet reaches from " << extent.lower[d] << " to "
            << extent.upper[d] << " m; add rows up to its edges";
    throw UserError(message.str());
  }
}

InletProfile read_inlet_profile(const ConfigTable& table, int across) {
  if (table.has("profile_file")) {
    if (table.has("profile")) {
      table.fail("profile", "is given beside profile_file; give one of them");
    }
    return read_profile_file(table, across);
  }
  InletProfile profile;
  const std::string kind = table.choice_or("profile", "uniform", {"uniform", "parabolic"});
  if (kind == "parabolic") profile.kind = ProfileKind::parabolic;
  for (int d = 0; d < 3; ++d) profile.along[d] = d != across && kind == "parabolic";
  if (!table.has("profile_along")) return profile;
  if (kind != "parabolic") table.fail("profile_along", "belongs to profile = \"parabolic\"");
  profile.along = {};
  for (const std::string& name : table.texts("profile_along")) {
    const auto found = std::find(axes.begin(), axes.end(), name);
    const int d = static_cast<int>(found - axes.begin());
    if (d == 3 || d == across) {
      table.fail("profile_along", "holds '" + name + "', but may hold '" + axes[(across + 1) % 3] +
                                      "' and '" + axes[(across + 2) % 3] + "'");
    }
    profile.along[d] = true;
  }
  return profile;
}

}  // namespace gasgrain::cfd
