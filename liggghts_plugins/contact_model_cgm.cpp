#include "liggghts_plugins/contact_model_cgm.hpp"

#include <granular_pair_style.h>
#include <granular_wall.h>

#include <map>
#include <memory>
#include <utility>

#include "coupling/shared/error.hpp"
#include "liggghts_plugins/pair_gran_cgm.hpp"
#include "liggghts_plugins/private_member.hpp"
#include "liggghts_plugins/stock_pair_style.hpp"
#include "liggghts_plugins/wall_gran_cgm.hpp"

// LIGGGHTS's factory of contact model names. contact_models.h, which declares it, needs the lists
// of models that LIGGGHTS generates while it builds itself; this declares what is called here. Only
// static or non-virtual members of an object that the library owns are used, so its layout is of no
// concern, and no translation unit sees both declarations.
namespace LIGGGHTS::ContactModels {
class Factory {
 public:
  static Factory& instance();
  static int64_t select(int& count, char**& arguments, LAMMPS_NS::Custom_contact_models custom);
  void addNormalModel(const std::string& name, int identifier);
  int getNormalModelId(const std::string& name);
  int getTangentialModelId(const std::string& name);
  int getCohesionModelId(const std::string& name);
  int getRollingModelId(const std::string& name);
  int getSurfaceModelId(const std::string& name);
};
}  // namespace LIGGGHTS::ContactModels

namespace gasgrain::plugins {

using Selector = int64_t (*)(int&, char**&, LAMMPS_NS::Custom_contact_models);
using PairFactoryBase = LIGGGHTS::Utils::AbstractFactory<LIGGGHTS::PairStyles::IGranularPairStyle>;
using WallFactoryBase = LIGGGHTS::Utils::AbstractFactory<LIGGGHTS::Walls::IGranularWall>;

struct PairSelectors {
  using Member = std::map<std::string, Selector> PairFactoryBase::*;
  friend Member private_member(PairSelectors);
};
struct WallSelectors {
  using Member = std::map<std::string, Selector> WallFactoryBase::*;
  friend Member private_member(WallSelectors);
};

using PairCreator = LIGGGHTS::PairStyles::IGranularPairStyle* (*)(LAMMPS_NS::LAMMPS*,
                                                                  LAMMPS_NS::PairGran*, int64_t);

struct PairStyleTable {
  using Member = std::map<std::pair<std::string, int>, PairCreator> PairFactoryBase::*;
  friend Member private_member(PairStyleTable);
};

namespace {

using Names = LIGGGHTS::ContactModels::Factory;

// Identifier of the normal model `cgm`: six bits of LIGGGHTS's model variant, far above stock's.
constexpr int cgm_identifier = 40;
constexpr int bits_per_model = 6;
constexpr int64_t model_mask = (1 << bits_per_model) - 1;

enum Slot { normal, tangential, cohesion, rolling, surface };

int model_in(int64_t variant, Slot slot) {
  return static_cast<int>((variant >> (bits_per_model * slot)) & model_mask);
}

int64_t variant_of(TangentialModel model, int normal_identifier = cgm_identifier) {
  Names& names = Names::instance();
  int identifier = names.getTangentialModelId("off");
  if (model == TangentialModel::history) identifier = names.getTangentialModelId("history");
  if (model == TangentialModel::no_history) identifier = names.getTangentialModelId("no_history");
  return LIGGGHTS::Utils::generate_gran_hashcode(
      normal_identifier, identifier, names.getCohesionModelId("off"),
      names.getRollingModelId("off"), names.getSurfaceModelId("default"));
}

// LIGGGHTS's selection of the models a script names, with `model cgm` kept to what it implements:
// an unknown combination would fall back to a stock model.
int64_t select_variant(int& count, char**& arguments, LAMMPS_NS::Custom_contact_models custom) {
  const int64_t variant = Names::select(count, arguments, std::move(custom));
  if (variant == -1 || model_in(variant, normal) != cgm_identifier) return variant;
  for (const auto model :
       {TangentialModel::off, TangentialModel::no_history, TangentialModel::history})
    if (variant == variant_of(model)) return variant;
  throw UserError(
      "gran model cgm: combine it with `tangential history`, `tangential no_history` or "
      "`tangential "
      "off` only; adhesion and rolling friction of its own are the properties cgmWorkOfAdhesion "
      "and cgmRollingFriction");
}

LIGGGHTS::PairStyles::IGranularPairStyle* create_pair(LAMMPS_NS::LAMMPS* lmp,
                                                      LAMMPS_NS::PairGran* parent,
                                                      int64_t variant) {
  return new PairGranCgm(lmp, parent, variant);
}

LIGGGHTS::Walls::IGranularWall* create_wall(LAMMPS_NS::LAMMPS* lmp, LAMMPS_NS::FixWallGran* parent,
                                            int64_t variant) {
  return new WallGranCgm(lmp, parent, variant);
}

// Stock's own creators of the variants that observe_stock_styles() replaced.
std::map<int, PairCreator>& stock_creators() {
  static std::map<int, PairCreator> creators;
  return creators;
}

LIGGGHTS::PairStyles::IGranularPairStyle* create_observed_pair(LAMMPS_NS::LAMMPS* lmp,
                                                               LAMMPS_NS::PairGran* parent,
                                                               int64_t variant) {
  const PairCreator create = stock_creators().at(static_cast<int>(variant));
  return new StockPairStyle(
      *lmp, parent,
      std::unique_ptr<LIGGGHTS::PairStyles::IGranularPairStyle>(create(lmp, parent, variant)));
}

// LIGGGHTS creates variants that it has not compiled specially by its variant without any model.
int variant_without_models() {
  Names& names = Names::instance();
  return static_cast<int>(LIGGGHTS::Utils::generate_gran_hashcode(
      names.getNormalModelId("off"), names.getTangentialModelId("off"),
      names.getCohesionModelId("off"), names.getRollingModelId("off"), 0));
}

void observe_stock_styles(std::map<std::pair<std::string, int>, PairCreator>& table) {
  const auto general = table.find({"gran", variant_without_models()});
  for (const char* name : {"hooke", "hooke/stiffness", "hertz"}) {
    for (const auto tangential :
         {TangentialModel::off, TangentialModel::no_history, TangentialModel::history}) {
      const int normal_identifier = Names::instance().getNormalModelId(name);
      const int variant = static_cast<int>(variant_of(tangential, normal_identifier));
      const auto special = table.find({"gran", variant});
      const auto creator = special != table.end() ? special : general;
      if (creator == table.end()) continue;
      stock_creators()[variant] = creator->second;
      table[{"gran", variant}] = create_observed_pair;
    }
  }
}

}  // namespace

template struct GrantAccess<PairStyleTable, &PairFactoryBase::styleTable>;
template struct GrantAccess<PairSelectors, &PairFactoryBase::variantSelectorTable>;
template struct GrantAccess<WallSelectors, &WallFactoryBase::variantSelectorTable>;

void register_contact_model_cgm() {
  auto& pairs = LIGGGHTS::PairStyles::Factory::instance();
  auto& walls = LIGGGHTS::Walls::Factory::instance();
  // every LIGGGHTS instance sets the selectors anew
  (pairs.*private_member(PairSelectors()))["gran"] = select_variant;
  (walls.*private_member(WallSelectors()))["gran"] = select_variant;

  static bool registered = false;
  if (std::exchange(registered, true)) return;
  observe_stock_styles(pairs.*private_member(PairStyleTable()));
  Names::instance().addNormalModel("cgm", cgm_identifier);
  for (const auto model :
       {TangentialModel::off, TangentialModel::no_history, TangentialModel::history}) {
    pairs.addStyle("gran", static_cast<int>(variant_of(model)), create_pair);
    walls.addStyle("gran", static_cast<int>(variant_of(model)), create_wall);
  }
}

TangentialModel tangential_model_of(int64_t variant) {
  for (const auto model : {TangentialModel::off, TangentialModel::no_history})
    if (variant == variant_of(model)) return model;
  return TangentialModel::history;
}

bool variant_contains(int64_t variant, const std::string& kind, const std::string& model) {
  Names& names = Names::instance();
  if (kind == "normal") return model_in(variant, normal) == names.getNormalModelId(model);
  if (kind == "tangential")
    return model_in(variant, tangential) == names.getTangentialModelId(model);
  if (kind == "cohesion") return model_in(variant, cohesion) == names.getCohesionModelId(model);
  if (kind == "rolling_friction")
    return model_in(variant, rolling) == names.getRollingModelId(model);
  if (kind == "surface") return model_in(variant, surface) == names.getSurfaceModelId(model);
  return false;
}

}  // namespace gasgrain::plugins
