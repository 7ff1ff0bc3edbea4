/*
 * instance.h: starting Vulkan, and ending it.
 */
#ifndef KRS_INSTANCE_H
#define KRS_INSTANCE_H

#include "runtime/device/driver.h"

/* Devices that do not have all of Vulkan (on macOS none has) are listed to those only who ask for
   them by this; and one that says so of itself wants to hear that it is known. */
#define PORTABILITY_SUBSET "VK_KHR_portability_subset" /* in a header of its own */

/* Makes gpu->driver with an instance; with validation, what its layers say goes to gpu->validation_message.
   instance_destroy in either case. */
bool instance_create(Gpu *gpu, bool validation);
void instance_destroy(Gpu *gpu);
/* Tells whether an extension is among those that are offered: by a device, or without one by Vulkan. */
bool vulkan_offers(Gpu *gpu, VkPhysicalDevice physical, const char *extension);

#endif
