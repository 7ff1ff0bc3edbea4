/*
 * ranges.h: pictures of some of the samples each (cli/picture/sample_sums.h), as one picture.
 */
#ifndef KRS_RANGES_H
#define KRS_RANGES_H

#include "cli/shell/commands.h"
#include "runtime/film/doublings.h"
#include "runtime/writer/picture.h"

/* The samples of a file. */
typedef struct SampleRange {
    bool     divided; /* not all; else what follows is 0 */
    uint32_t first, last, all;
    bool     noise; /* it has what errors are estimated from, with this floor: */
    float    noise_floor;
} SampleRange;

/* Finds them; NULL, or what is wrong with the file. */
const char *range_read(const Picture *picture, SampleRange *range);

/* The sums of the pixels of a picture. */
typedef struct RangeSums {
    Exact (*sums)[4];
    Doubling *doublings;
} RangeSums;

/* These need so many pixels; false: no memory is left. */
bool ranges_new(RangeSums *sums, size_t pixels);
void ranges_free(RangeSums *sums);
/* Adds `count` pixels of a file, in the order of ranges, to those from `pixel` on.  `planes` are those of its channels,
   from `from` on; `begins`: no range has been added to them. */
void ranges_add(RangeSums *sums, size_t pixel, size_t count, const SampleRange *range,
                const Picture *picture, float *const *planes, size_t from, bool begins);
/* Writes what they make of the samples from `first` to `last` to the planes of the picture.  `noise`: they have estimates
   of errors. */
void ranges_finish(const RangeSums *sums, size_t pixels, uint32_t first, uint32_t last, bool noise,
                   const Picture *picture, float *const *planes);

#endif
