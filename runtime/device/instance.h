/*
 * instance.h: the steps before a device is opened: starting Vulkan, and choosing a device.
 */
#ifndef KRS_INSTANCE_H
#define KRS_INSTANCE_H

#include "runtime/device/gpu.h"

#define NO_DEVICE \
    "no usable Vulkan device: install a driver, for example Debian's mesa-vulkan-drivers"

/* Devices that do not have all of Vulkan (on macOS none has) are listed to those only who ask for
   them by this; and one that says so of itself wants to hear that it is known. */
#define PORTABILITY_SUBSET "VK_KHR_portability_subset" /* in a header of its own */

/* ---- instance.c ---- */
bool instance_create(Gpu *gpu, bool validation);
/* Whether an extension is among those that are offered: by a device, or without one by Vulkan. */
bool vulkan_offers(Gpu *gpu, VkPhysicalDevice physical, const char *extension);

/* ---- devices.c ---- */
/* Takes the device that the words ask for, and its queue family, into gpu; see krs devices. */
bool choose_device(Gpu *gpu, const char *words);

#endif
