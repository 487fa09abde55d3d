#include "liggghts_plugins/engine/kernel.hpp"

namespace gasgrain::plugins {

extern const ContactKernel kernel_generic;

const ContactKernel& contact_kernel() {
  return kernel_generic;
}

}  // namespace gasgrain::plugins
