/*
 * devices.h: which devices there are, and which of them is taken.
 */
#ifndef KRS_DEVICES_H
#define KRS_DEVICES_H

#include "runtime/device/gpu_state.h"

/* Lists the devices there are, as krs_devices. */
bool gpu_list(Gpu *gpu, KrsDevice *devices, size_t capacity, size_t *count);
/* Describes the device that was opened. */
KrsDevice gpu_describe(const Gpu *gpu);

/* Tells whether shaders read texels on a device with this limit; else they read storage buffers. */
bool devices_read_texels(uint32_t texels);

/* Takes the device that the words ask for, and its queue family, into gpu; see krs devices. */
bool choose_device(Gpu *gpu, const char *words);

#endif
