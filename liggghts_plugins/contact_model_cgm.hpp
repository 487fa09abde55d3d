// Makes `model cgm` known to LIGGGHTS's factories of contact models, for pairs and walls.
#pragma once

#include <cstdint>
#include <string>

#include "liggghts_plugins/contact_settings.hpp"

namespace gasgrain::plugins {

// Registers the model with the factories of this process; call again for every LIGGGHTS instance.
void register_contact_model_cgm();

// The tangential model that a LIGGGHTS model variant of `model cgm` names.
TangentialModel tangential_model_of(int64_t variant);

// Whether a variant of `model cgm` contains that model; kind as in a script ("normal", ...).
bool variant_contains(int64_t variant, const std::string& kind, const std::string& model);

}  // namespace gasgrain::plugins
