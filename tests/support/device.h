/*
 * device.h: the Vulkan device that tests run on.
 */
#ifndef SUPPORT_DEVICE_H
#define SUPPORT_DEVICE_H

/* For KrsRendererOptions: what KRS_DEVICE says (`make test DEVICE=...`), else NULL, which is the
   device that krs takes by itself. */
const char *tested_device(void);

#endif
