/*
 * device.c: the Vulkan device that tests run on.
 */
#include "tests/support/device.h"

#include <stdlib.h>

const char *tested_device(void) { return getenv("KRS_DEVICE"); }
