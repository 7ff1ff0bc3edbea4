/*
 * denoised.h: the colours of a rendered frame with less noise.
 */
#ifndef KRS_CLI_DENOISED_H
#define KRS_CLI_DENOISED_H

#include "cli/shell/commands.h"
#include "denoise/denoise.h"

/* The AOVs that it takes, bits of KrsAov. */
#define DENOISING_AOVS \
    (KRS_AOV_DEPTH | KRS_AOV_POSITION | KRS_AOV_NORMAL | KRS_AOV_ALBEDO | KRS_AOV_NOISE)

/* The channels of a file that have the result. */
extern const char *const denoised_channels[3];

/* Refuses what cannot be denoised: parts of a picture, which have no neighbours, two pictures, and groups of lights. */
KrsStatus denoised_check(const Options *options, bool light_groups);

/* Denoises a picture in STAGE_DENOISE; *colors has R, G, B for free(), NULL on any status but KRS_OK. */
KrsStatus denoised_make(const Options *options, const DenoisePicture *picture, float (**colors)[3]);

/* Returns the standard deviation of a colour's error, of which `noise` is relative to the colour and a floor. */
static inline float denoised_deviation(float noise, float r, float g, float b, double floor)
{
    return noise * ((r + g + b) / 3 + (float)floor);
}

/* Denoises a frame that was rendered with DENOISING_AOVS; *colors has R, G, B and A. */
KrsStatus denoised_frame(const Options *options, const KrsPicture *picture, double noise_floor,
                         float (**colors)[4]);

#endif
