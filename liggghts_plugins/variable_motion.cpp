#include "liggghts_plugins/variable_motion.hpp"

#include <input.h>
#include <lammps.h>
#include <modify.h>
#include <update.h>
#include <variable.h>

#include <algorithm>
#include <cctype>

#include "coupling/shared/error.hpp"
#include "liggghts_plugins/private_member.hpp"

namespace gasgrain::plugins {

using LAMMPS_NS::LAMMPS;
using LAMMPS_NS::Variable;

struct VariableTexts {
  using Member = char*** Variable::*;
  friend Member private_member(VariableTexts);
};
template struct GrantAccess<VariableTexts, &Variable::data>;

namespace {

constexpr const char* words_of_time[] = {
    "step", "dt",    "time",  "elapsed", "elaplong", "PI",      "sqrt",      "exp",     "ln",
    "log",  "sin",   "cos",   "tan",     "asin",     "acos",    "atan",      "atan2",   "ceil",
    "abs",  "floor", "round", "ramp",    "stagger",  "logfreq", "vdisplace", "swiggle", "cwiggle"};

int find(LAMMPS& lmp, std::string name) {
  return lmp.input->variable->find(name.data());
}

// Every word of the formula is one of time or a variable of which the same is true.
bool depends_on_time_alone(LAMMPS& lmp, const std::string& name) {
  Variable& variables = *lmp.input->variable;
  const int index = find(lmp, name);
  if (index < 0) return false;
  if (!variables.equalstyle(index)) return true;  // a text that does not change
  const std::string formula = (variables.*private_member(VariableTexts()))[index][0];
  const auto in_word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
  };
  for (std::size_t at = 0; at < formula.size();) {
    std::size_t end = at;
    while (end < formula.size() && in_word(formula[end])) ++end;
    const std::string word = formula.substr(at, end - at);
    at = std::max(end, at + 1);
    if (word.empty() || std::isdigit(static_cast<unsigned char>(word[0]))) continue;
    if (word.starts_with("v_")) {
      if (!depends_on_time_alone(lmp, word.substr(2))) return false;
    } else if (std::find(std::begin(words_of_time), std::end(words_of_time), word) ==
               std::end(words_of_time)) {
      return false;
    }
  }
  return true;
}

}  // namespace

VariableMotion::VariableMotion(Kind kind, char** words, const std::string& where) : kind_(kind) {
  for (int d = 0; d < 3; ++d) {
    const std::string word = words[d];
    if (word == "NULL") continue;
    if (!word.starts_with("v_") || word.size() < 3)
      throw UserError(where + ": '" + word +
                      "' is no variable; write v_name for each of x, y, z, or NULL for none");
    names_[d] = word.substr(2);
  }
}

void VariableMotion::check(LAMMPS& lmp, const std::string& where) const {
  for (const std::string& name : names_) {
    if (name.empty()) continue;
    const int index = find(lmp, name);
    if (index < 0)
      throw UserError(where + ": there is no variable '" + name + "'; define it by `variable " +
                      name + " equal ...` before the first run");
    if (!lmp.input->variable->equalstyle(index))
      throw UserError(where + ": variable '" + name +
                      "' is not of style equal, the only one that can move a wall");
  }
}

bool VariableMotion::follows_time(LAMMPS& lmp) const {
  return std::all_of(names_.begin(), names_.end(), [&](const std::string& name) {
    return name.empty() || depends_on_time_alone(lmp, name);
  });
}

Vec3 VariableMotion::values(LAMMPS& lmp) const {
  Vec3 result = Vec3::Zero();
  lmp.modify->clearstep_compute();
  for (int d = 0; d < 3; ++d)
    if (!names_[d].empty()) result[d] = lmp.input->variable->compute_equal(find(lmp, names_[d]));
  lmp.modify->addstep_compute(lmp.update->ntimestep + 1);
  return result;
}

bool VariableMotion::advance(LAMMPS& lmp) {
  const double step = static_cast<double>(lmp.update->ntimestep);
  if (step == last_step_) return false;
  const Vec3 now = values(lmp), before = displacement_;
  const bool goes_on = last_step_ >= 0.0;
  const double time = (step - last_step_) * lmp.update->dt;
  if (kind_ == Kind::displacement) {
    displacement_ = now;
    velocity_ = goes_on ? Vec3((now - before) / time) : Vec3(Vec3::Zero());
  } else {
    if (goes_on) displacement_ += 0.5 * time * (velocity_ + now);
    velocity_ = now;
  }
  last_way_ = goes_on ? (displacement_ - before).norm() : 0.0;
  last_step_ = step;
  return true;
}

std::vector<double> VariableMotion::state() const {
  std::vector<double> state(displacement_.begin(), displacement_.end());
  state.insert(state.end(), velocity_.begin(), velocity_.end());
  state.insert(state.end(), {last_way_, last_step_});
  return state;
}

void VariableMotion::set_state(const double* state) {
  displacement_ = Eigen::Map<const Vec3>(state);
  velocity_ = Eigen::Map<const Vec3>(state + 3);
  last_way_ = state[6];
  last_step_ = state[7];
}

}  // namespace gasgrain::plugins
