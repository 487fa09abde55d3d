#include "liggghts_plugins/wall_motion.hpp"

#include "coupling/shared/error.hpp"

namespace gasgrain::plugins {

namespace {

struct Keyword {
  const char* name;
  int values;
};

constexpr Keyword keywords[] = {{"translate", 3}, {"oscillate", 4},    {"rotate", 7},  {"start", 1},
                                {"stop", 1},      {"displacement", 3}, {"velocity", 3}};

void set_oscillation(Motion& motion, const double* v, const std::string& where) {
  if (!(v[3] > 0))
    throw UserError(where + ": oscillate: period = " + std::to_string(v[3]) +
                    " s must be positive");
  motion.amplitude = Vec3(v[0], v[1], v[2]);
  motion.period = v[3];
}

void set_rotation(Motion& motion, const double* v, const std::string& where) {
  const Vec3 axis(v[3], v[4], v[5]);
  if (axis.norm() == 0.0)
    throw UserError(where + ": rotate: the axis must not be zero, it gives a direction");
  motion.centre = Vec3(v[0], v[1], v[2]);
  motion.axis = axis.normalized();
  motion.rate = v[6];
}

}  // namespace

int read_motion_keyword(WallMotion& motion, Arguments arguments, const std::string& where) {
  const std::string name = arguments.values[0];
  const Keyword* keyword = nullptr;
  for (const Keyword& known : keywords)
    if (name == known.name) keyword = &known;
  if (!keyword) return 0;
  if (arguments.count <= keyword->values)
    throw UserError(where + ": " + name + " needs " + std::to_string(keyword->values) +
                    " values, but " + std::to_string(arguments.count - 1) + " follow");
  char** words = arguments.values + 1;
  if (name == "displacement" || name == "velocity") {
    if (motion.by_variable.exists())
      throw UserError(where + ": give displacement or velocity, once");
    motion.by_variable = VariableMotion(
        name == "velocity" ? VariableMotion::Kind::velocity : VariableMotion::Kind::displacement,
        words, where);
    return 1 + keyword->values;
  }
  double v[7];
  for (int n = 0; n < keyword->values; ++n)
    v[n] = script_number(words[n], where.c_str(), name.c_str());
  if (name == "translate") motion.rigid.velocity = Vec3(v[0], v[1], v[2]);
  if (name == "oscillate") set_oscillation(motion.rigid, v, where);
  if (name == "rotate") set_rotation(motion.rigid, v, where);
  if (name == "start") motion.rigid.start = v[0];
  if (name == "stop") motion.rigid.stop = v[0];
  return 1 + keyword->values;
}

void check_motion(const WallMotion& motion, const std::string& where) {
  if (motion.by_variable.exists() && !motion.rigid.is_at_rest())
    throw UserError(where +
                    ": displacement or velocity by variables stands alone, without translate, "
                    "oscillate and rotate");
  const Motion still;
  const bool times = motion.rigid.start != still.start || motion.rigid.stop != still.stop;
  if (times && motion.rigid.is_at_rest())
    throw UserError(where + ": start and stop belong to translate, oscillate or rotate");
  if (motion.rigid.stop < motion.rigid.start)
    throw UserError(where + ": stop = " + std::to_string(motion.rigid.stop) +
                    " s lies before start = " + std::to_string(motion.rigid.start) + " s");
}

}  // namespace gasgrain::plugins
