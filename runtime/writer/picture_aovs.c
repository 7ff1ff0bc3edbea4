/*
 * picture_aovs.c: which array of a picture is which channel of a file.
 */
#include "runtime/writer/picture_aovs.h"

#include <string.h>

/* An array of KrsPicture: how many numbers a pixel has, and the channel of each. */
static const struct {
    KrsAov      aov;
    size_t      offset, numbers;
    SampleType  type;
    const char *channels[4];
} arrays[AOV_ARRAYS] = {
#define KRS_AOV(id, bit, aov, about, arrays) arrays
#define KRS_ARRAY(aov, member, type, numbers, row, first, sample, ...) \
    {KRS_AOV_##aov, offsetof(KrsPicture, member), numbers, SAMPLE_##sample, {__VA_ARGS__}},
#include "krs/aovs.def"
#undef KRS_ARRAY
#undef KRS_AOV
};

size_t aov_channels(const KrsPicture *picture, uint32_t aovs, PictureChannel channels[AOV_CHANNELS])
{
    size_t count = 0;
    for (size_t i = 0; i < AOV_ARRAYS; i++) {
        const char *samples; /* floats and integers alike: the pointer is taken as bytes */
        memcpy(&samples, (const char *)picture + arrays[i].offset, sizeof samples);
        if (!samples || !(arrays[i].aov & aovs))
            continue;
        for (size_t k = 0; k < arrays[i].numbers; k++)
            channels[count++] = (PictureChannel){.name    = arrays[i].channels[k],
                                                 .type    = arrays[i].type,
                                                 .samples = samples + k * sizeof(float),
                                                 .stride  = arrays[i].numbers};
    }
    return count;
}
