/*
 * sample_sums.c: pictures of some of the samples, which `krs merge` puts together.
 */
#include "cli/picture/sample_sums.h"

#include <string.h>

#include "cli/shell/console.h"

#define SUM_OF(name) SUM_LAYER name "0", SUM_LAYER name "1", SUM_LAYER name "2", SUM_LAYER name "3"
const char *const sum_channels[SUM_AND_NOISE_NUMBERS] = {SUM_OF("R"),
                                                         SUM_OF("G"),
                                                         SUM_OF("B"),
                                                         SUM_OF("A"),
                                                         SUM_OF("noise.R"),
                                                         SUM_OF("noise.G"),
                                                         SUM_OF("noise.B"),
                                                         SUM_LAYER "noise.variance",
                                                         SUM_LAYER "noise.error"};

/* Tells whether the errors of pixels are estimated in the middle of a range that has no estimate before. */
static bool misses_estimate(const Options *options)
{
    for (uint32_t at = 2 * SAMPLES_OF_BLOCK; at <= options->last_sample; at *= 2)
        if (options->first_sample > 0 && at > options->first_sample)
            return true;
    return false;
}

KrsStatus samples_check(const Options *options, const KrsRenderOptions *how, double noise)
{
    const uint32_t end = options->last_sample + 1;
    if (!options->samples_divided)
        return KRS_OK;
    if (options->first_sample % SAMPLES_OF_BLOCK != 0 ||
        (end % SAMPLES_OF_BLOCK != 0 && end != how->samples))
        return say_usage(options,
                         "ranges of --samples begin at multiples of %d, and end before one or with "
                         "the last sample",
                         SAMPLES_OF_BLOCK);
    if (noise > 0)
        return say_usage(options, "a range of --samples cannot end by --noise");
    if (options->light_groups || how->mattes || options->stereo >= 0 || options->depth_in ||
        options->plate)
        return say_usage(options, "a range of --samples has neither --light-groups nor "
                                  "--cryptomatte, --stereo, --depth-in or --plate");
    if (options->aovs != KRS_AOV_ALL && options->aovs & KRS_AOV_NOISE && misses_estimate(options))
        return say_usage(options, "the noise is estimated when samples have doubled: ranges behind "
                                  "the first may have no power of 2 in their middle");
    return KRS_OK;
}

/* Tells whether the value of an option changes the samples, and no other text says it. */
static bool is_setting(OptionId id)
{
    switch (id) {
    case OPTION_OUTPUT:
    case OPTION_CROP:
    case OPTION_DEVICE:
    case OPTION_FRAMES:
    case OPTION_SAMPLES:
    case OPTION_SET:
    case OPTION_SIZE:
    case OPTION_TIME: return false;
    default: return option_changes_pictures(id);
    }
}

static const char *describe_settings(const Options *options, const char *device)
{
    Text text = {.arena = options->arena};
    text_format(&text, "%s", device);
    for (OptionId id = 0; id < OPTION_COUNT; id++)
        for (size_t i = 0; is_setting(id) && i < options->given.count; i++)
            if (options->given.items[i].id == id) {
                const char *value = options->given.items[i].value;
                text_format(&text, " --%s%s%s", option_info[id].name, value ? "=" : "",
                            value ? value : "");
            }
    return text.bytes;
}

size_t samples_texts(const Options *options, const char *device, PictureText *texts, size_t count)
{
    Text range = {.arena = options->arena};
    text_format(&range, "%u..%u/%u", options->first_sample, options->last_sample,
                options->how.samples);
    texts[count++] = (PictureText){SAMPLES_TEXT, range.bytes};
    texts[count++] = (PictureText){SETTINGS_TEXT, describe_settings(options, device)};
    return count;
}

size_t samples_channels(const SampleSums *sums, PictureChannel channels[SUM_AND_NOISE_NUMBERS])
{
    const size_t count = sums->noise ? SUM_AND_NOISE_NUMBERS : SUM_NUMBERS;
    for (size_t i = 0; i < count; i++)
        channels[i] = (PictureChannel){.name    = sum_channels[i],
                                       .type    = SAMPLE_UINT,
                                       .samples = &sums->numbers[0][i],
                                       .stride  = SUM_AND_NOISE_NUMBERS};
    return count;
}
