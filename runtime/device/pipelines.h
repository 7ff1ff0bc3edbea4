/*
 * pipelines.h: what a driver keeps of the pipelines it compiled, from run to run.
 *
 * A VkPipelineCache, kept in the cache's folder for each device and driver.  Where there is no
 * folder, or what lies there does not fit, gpu->driver->pipelines starts empty; nothing here fails.
 */
#ifndef KRS_PIPELINES_H
#define KRS_PIPELINES_H

#include "runtime/device/driver.h"

/* These are called after the device was opened, and before it is closed. */
void pipelines_open(Gpu *gpu);
void pipelines_close(Gpu *gpu);

/* Tells whether a driver's data is of this device: drivers trust what they are given. */
bool pipelines_fit(const VkPhysicalDeviceProperties *device, const void *bytes, size_t length);

#endif
