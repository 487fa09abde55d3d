#include <string>
#include <vector>

#include "coupling/shared/error.hpp"
#include "liggghts_plugins/engine/kernel.hpp"

namespace gasgrain::plugins {

extern const ContactKernel kernel_generic;
#ifdef GASGRAIN_X86_KERNELS
extern const ContactKernel kernel_avx2;
extern const ContactKernel kernel_avx512;
#endif

namespace {

// Those that this processor can run, best first.
std::vector<const ContactKernel*> usable_kernels() {
  std::vector<const ContactKernel*> kernels;
#ifdef GASGRAIN_X86_KERNELS
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    kernels.push_back(&kernel_avx512);
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    kernels.push_back(&kernel_avx2);
#endif
  kernels.push_back(&kernel_generic);
  return kernels;
}

const ContactKernel*& chosen_kernel() {
  static const ContactKernel* kernel = usable_kernels().front();
  return kernel;
}

}  // namespace

const ContactKernel& contact_kernel() {
  return *chosen_kernel();
}

void choose_contact_kernel(const std::string& name) {
  std::string names;
  for (const ContactKernel* kernel : usable_kernels()) {
    if (kernel->name == name) {
      chosen_kernel() = kernel;
      return;
    }
    names += (names.empty() ? "" : ", ") + std::string(kernel->name);
  }
  throw UserError("gasgrain_engine: no kernel '" + name + "' on this processor; there are " +
                  names);
}

}  // namespace gasgrain::plugins
