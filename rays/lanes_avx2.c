/* lanes_avx2.c: rays for processors with AVX2; their flags are in the Makefile. */
#define RAY_SET      ray_set_avx2
#define RAY_SET_NAME "avx2"
#include "rays/lanes_loop.h"
