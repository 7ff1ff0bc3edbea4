/*
 * noise.h: ends the samples of pixels whose error is small (noise.comp).
 */
#ifndef KRS_NOISE_H
#define KRS_NOISE_H

#include "runtime/tracer/job.h"
#include "runtime/tracer/plan.h"

/* Tells whether the error of pixels is estimated, for these options. */
bool noise_is_wanted(const KrsRenderOptions *options);
/* Lists the pixels that go on, before samples are added to the band in the buffers, whose pixels
   have `samples` so far.  Clears *unfinished if all of them have ended. */
bool noise_resume(Job *job, const Plan *plan, const WorkBlock *work, uint32_t samples,
                  bool *unfinished);
/* Estimates errors after a sample of each pixel: there are `samples` now. */
bool noise_take(Job *job, const Plan *plan, const WorkBlock *work, uint32_t samples,
                bool *unfinished);
/* Gives pixels that have ended their colours back, after all samples. */
bool noise_restore(Job *job, const WorkBlock *work, uint32_t samples);

/* Returns by how much the error after so many samples is smaller than that which was estimated last; 0: none was. */
float noise_since(uint32_t samples);
/* Completes the AOVs of noise of a picture for pixels that have not ended. */
void noise_finish(KrsPicture *picture);

#endif
