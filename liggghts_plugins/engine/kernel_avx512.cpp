// kernel.cpp for processors with AVX-512; the instruction set is a compile option of this file.
#define GASGRAIN_KERNEL kernel_avx512
#define GASGRAIN_KERNEL_NAME "avx512"
#include "liggghts_plugins/engine/kernel.cpp"
