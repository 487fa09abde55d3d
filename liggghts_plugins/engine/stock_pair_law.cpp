// Coefficients of a pair of effective mass m and effective radius r, with Y, G, beta and ln e of
// the pair's types (LIGGGHTS 3.8.0 manual, gran model hooke, hooke/stiffness and hertz):
//
//   hooke/stiffness  k = kn, k_t = kt, eta = m gamman or gamman_abs, eta_t alike
//   hooke            k = 16/15 sqrt(r) Y (15 m V^2 / (16 sqrt(r) Y))^(1/5), V the characteristic
//                    velocity; eta = sqrt(4 m k ln^2 e / (ln^2 e + pi^2)); k_t = k (or 2/7 of it)
//   hertz            k = 4/3 Y sqrt(r delta), k_t = 8 G sqrt(r delta),
//                    eta = -2 sqrt(5/6) beta sqrt(2 Y sqrt(r delta) m),
//                    eta_t = -2 sqrt(5/6) beta sqrt(8 G sqrt(r delta) m)
//
// SI and other units without conversion of pressures (nktv2p = 1) only.
#include "liggghts_plugins/engine/stock_pair_law.hpp"

#include <force.h>
#include <lammps.h>
#include <property_registry.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

#include "liggghts_plugins/stock_pair_style.hpp"

namespace gasgrain::plugins {

namespace {

constexpr const char* where = "fused engine";

struct StockOptions {
  bool tangential_damping = true;
  bool absolute_damping = false;
  bool limit_force = false;
  bool two_sevenths = false;  // ktToKnUser
};

struct EffectivePair {
  double mass, radius;
};

EffectivePair effective(const PairMember& a, const PairMember& b) {
  double mass = a.mass * b.mass / (a.mass + b.mass);
  if (a.frozen) mass = b.mass;
  if (b.frozen) mass = a.mass;
  return {mass, a.radius * b.radius / (a.radius + b.radius)};
}

using Matrix = const double* const*;

class Properties {
 public:
  explicit Properties(LAMMPS_NS::LAMMPS& lmp) : registry_(lmp.force->registry) {}
  Matrix matrix(const char* name) { return registry_.getMatrixProperty(name, where)->data; }
  double scalar(const char* name) { return registry_.getScalarProperty(name, where)->data; }

 private:
  PropertyRegistry& registry_;
};

// What the three models share.
class StockLaw : public PairLaw {
 public:
  StockLaw(Properties properties, TangentialModel tangential, const StockOptions& options)
      : options_(options),
        tangential_(tangential),
        friction_(tangential == TangentialModel::off ? nullptr : properties.matrix("coeffFrict")) {}

  PairModel model() const override {
    return {.normal = NormalModel::linear,
            .tangential = tangential_,
            .least_normal_force =
                options_.limit_force ? 0.0 : -std::numeric_limits<double>::infinity()};
  }
  int history_offset() const override { return tangential_ == TangentialModel::history ? 0 : -1; }

  PairCoefficients between(const PairMember& a, const PairMember& b) const override {
    PairCoefficients c = normal_and_tangential(a.type, b.type, effective(a, b));
    if (!options_.tangential_damping) c.eta_t = 0.0;
    if (friction_) c.mu = friction_[a.type][b.type];
    return c;
  }

 protected:
  virtual PairCoefficients normal_and_tangential(int i, int j, const EffectivePair& pair) const = 0;

  StockOptions options_;

 private:
  TangentialModel tangential_;
  Matrix friction_;
};

class HookeStiffness : public StockLaw {
 public:
  HookeStiffness(Properties p, TangentialModel tangential, const StockOptions& options)
      : StockLaw(p, tangential, options),
        k_(p.matrix("k_n")),
        k_t_(p.matrix("k_t")),
        gamma_(p.matrix(options.absolute_damping ? "gamman_abs" : "gamman")),
        gamma_t_(p.matrix(options.absolute_damping ? "gammat_abs" : "gammat")) {}
  std::string name() const override { return "hooke/stiffness"; }

 private:
  PairCoefficients normal_and_tangential(int i, int j, const EffectivePair& pair) const override {
    const double mass = options_.absolute_damping ? 1.0 : pair.mass;
    return {.k = k_[i][j],
            .eta = mass * gamma_[i][j],
            .k_t = k_t_[i][j],
            .eta_t = mass * gamma_t_[i][j],
            .mu = 0.0,
            .unused = {}};
  }
  Matrix k_, k_t_, gamma_, gamma_t_;
};

class Hooke : public StockLaw {
 public:
  Hooke(Properties p, TangentialModel tangential, const StockOptions& options)
      : StockLaw(p, tangential, options),
        young_(p.matrix("Yeff")),
        log_restitution_(p.matrix("coeffRestLog")),
        velocity_(p.scalar("charVel")) {}
  std::string name() const override { return "hooke"; }

 private:
  PairCoefficients normal_and_tangential(int i, int j, const EffectivePair& pair) const override {
    const double stiffness = std::sqrt(pair.radius) * young_[i][j];
    const double k = 16.0 / 15.0 * stiffness *
                     std::pow(15.0 * pair.mass * velocity_ * velocity_ / (16.0 * stiffness), 0.2);
    const double square = log_restitution_[i][j] * log_restitution_[i][j];
    const double eta =
        std::sqrt(4.0 * pair.mass * k * square / (square + std::numbers::pi * std::numbers::pi));
    return {.k = k,
            .eta = eta,
            .k_t = options_.two_sevenths ? two_sevenths * k : k,
            .eta_t = eta,
            .mu = 0.0,
            .unused = {}};
  }
  static constexpr double two_sevenths = 0.285714286;  // LIGGGHTS's digits
  Matrix young_, log_restitution_;
  double velocity_;
};

class Hertz : public StockLaw {
 public:
  Hertz(Properties p, TangentialModel tangential, const StockOptions& options)
      : StockLaw(p, tangential, options),
        young_(p.matrix("Yeff")),
        shear_(p.matrix("Geff")),
        beta_(p.matrix("betaeff")) {}
  std::string name() const override { return "hertz"; }
  PairModel model() const override {
    PairModel model = StockLaw::model();
    model.normal = NormalModel::hertz;
    return model;
  }

 private:
  PairCoefficients normal_and_tangential(int i, int j, const EffectivePair& pair) const override {
    const double root = std::sqrt(pair.radius);
    const double normal = 2.0 * young_[i][j] * root, tangential = 8.0 * shear_[i][j] * root;
    const double damping = -2.0 * std::sqrt(5.0 / 6.0) * beta_[i][j];
    return {.k = 4.0 / 3.0 * young_[i][j] * root,
            .eta = damping * std::sqrt(normal * pair.mass),
            .k_t = tangential,
            .eta_t = damping * std::sqrt(tangential * pair.mass),
            .mu = 0.0,
            .unused = {}};
  }
  Matrix young_, shear_, beta_;
};

// Options of these models that the engine computes; any other one that is on is an obstacle.
StockOptions understand(std::vector<std::string>& obstacles,
                        const std::vector<std::string>& words) {
  StockOptions options;
  const std::map<std::string, bool*> known = {{"tangential_damping", &options.tangential_damping},
                                              {"absolute_damping", &options.absolute_damping},
                                              {"limitForce", &options.limit_force},
                                              {"ktToKnUser", &options.two_sevenths}};
  for (std::size_t n = 0; n + 1 < words.size(); n += 2) {
    const bool on = words[n + 1] == "on";
    if (const auto found = known.find(words[n]); found != known.end())
      *found->second = on;
    else if (on || words[n + 1] != "off")
      obstacles.push_back("pair_style gran option " + words[n]);
  }
  return options;
}

std::optional<TangentialModel> tangential_of(StockPairStyle& style) {
  if (style.contact_match("tangential", "history")) return TangentialModel::history;
  if (style.contact_match("tangential", "no_history")) return TangentialModel::no_history;
  if (style.contact_match("tangential", "off")) return TangentialModel::off;
  return std::nullopt;
}

}  // namespace

StockLawResult make_stock_law(LAMMPS_NS::LAMMPS& lmp, StockPairStyle& style) {
  StockLawResult result;
  const std::optional<TangentialModel> tangential = tangential_of(style);
  if (!tangential) result.obstacles.push_back("tangential model of the pair style");
  if (!style.options_are_known())
    result.obstacles.push_back("pair_style from a restart file (state it in the script)");
  if (lmp.force->nktv2p != 1.0) result.obstacles.push_back("units with pressures to convert");
  const StockOptions options = understand(result.obstacles, style.options());
  if (!result.obstacles.empty()) return result;
  const Properties properties(lmp);
  if (style.contact_match("normal", "hooke/stiffness"))
    result.law = std::make_unique<HookeStiffness>(properties, *tangential, options);
  else if (style.contact_match("normal", "hooke"))
    result.law = std::make_unique<Hooke>(properties, *tangential, options);
  else if (style.contact_match("normal", "hertz"))
    result.law = std::make_unique<Hertz>(properties, *tangential, options);
  else
    result.obstacles.push_back("normal model of the pair style");
  return result;
}

}  // namespace gasgrain::plugins
