/* lanes_plain.c: rays for plain C; their flags are in the Makefile. */
#define RAY_SET      ray_set_plain
#define RAY_SET_NAME "plain"
#include "rays/lanes_loop.h"
