/*
 * devices.h: which Vulkan devices there are, and which of them is taken.
 */
#ifndef KRS_DEVICES_H
#define KRS_DEVICES_H

#include "runtime/device/gpu_state.h"

/* The devices there are, as krs_devices. */
bool      gpu_list(Gpu *gpu, KrsDevice *devices, size_t capacity, size_t *count);
KrsDevice gpu_describe(VkPhysicalDevice physical);

/* Tells whether shaders read texels on a device with these limits; else they read storage buffers. */
bool devices_read_texels(const VkPhysicalDeviceLimits *limits);

/* Takes the device that the words ask for, and its queue family, into gpu; see krs devices. */
bool choose_device(Gpu *gpu, const char *words);

#endif
