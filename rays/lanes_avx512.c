/* lanes_avx512.c: rays for processors with AVX-512; their flags are in the Makefile. */
#define RAY_SET      ray_set_avx512
#define RAY_SET_NAME "avx512"
#include "rays/lanes_loop.h"
