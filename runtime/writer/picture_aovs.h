/*
 * picture_aovs.h: the AOVs of a picture as channels of an OpenEXR file, by aovs.def.
 */
#ifndef KRS_WRITER_PICTURE_AOVS_H
#define KRS_WRITER_PICTURE_AOVS_H

#include "krs/vulkan.h"
#include "runtime/writer/picture.h"

/* The channels at most: four for each array. */
enum {
#define KRS_AOV(id, bit, aov, about, arrays) arrays
#define KRS_ARRAY(aov, member, ...)          AOV_ARRAY_##member,
#include "krs/aovs.def"
#undef KRS_ARRAY
#undef KRS_AOV
    AOV_ARRAYS,
    AOV_CHANNELS = 4 * AOV_ARRAYS
};

/* Lists what the picture has of these AOVs, bits of KrsAov; returns how many channels there are. */
size_t aov_channels(const KrsPicture *picture, uint32_t aovs,
                    PictureChannel channels[AOV_CHANNELS]);

#endif
