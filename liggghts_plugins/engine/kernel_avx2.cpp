// kernel.cpp for processors with AVX2; the instruction set is a compile option of this file.
#define GASGRAIN_KERNEL kernel_avx2
#define GASGRAIN_KERNEL_NAME "avx2"
#include "liggghts_plugins/engine/kernel.cpp"
