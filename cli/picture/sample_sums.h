/*
 * sample_sums.h: pictures of some of the samples, which `krs merge` puts together.
 *
 * Such an EXR has the sums of its samples exactly, and says which they are, and how they were made.
 */
#ifndef KRS_CLI_SAMPLE_SUMS_H
#define KRS_CLI_SAMPLE_SUMS_H

#include "cli/shell/commands.h"
#include "runtime/film/sample_blocks.h"
#include "runtime/writer/picture.h"

/* The channels of the numbers of SampleSums. */
#define SUM_LAYER "sum."
extern const char *const sum_channels[SUM_AND_NOISE_NUMBERS];

/* The texts of such a file: "0..63/256"; options and device. */
#define SAMPLES_TEXT  "krs:samples"
#define SETTINGS_TEXT "krs:settings"
enum { SAMPLE_TEXTS = 2 };
/* That of every file with an estimate of the noise: KrsRenderOptions.noise_floor. */
#define NOISE_FLOOR_TEXT "krs:noise_floor"

/* Refuses ranges of samples that do not begin and end with blocks, or with options whose pictures cannot be divided so. */
KrsStatus samples_check(const Options *options, const KrsRenderOptions *how, double noise);
/* Adds these texts, and returns how many there are then. */
size_t samples_texts(const Options *options, const char *device, PictureText *texts, size_t count);
/* Describes the channels; returns their number. */
size_t samples_channels(const SampleSums *sums, PictureChannel channels[SUM_AND_NOISE_NUMBERS]);

#endif
