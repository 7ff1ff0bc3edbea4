/*
 * view.h: from what the scene says about camera and sky to what the kernels need.
 */
#ifndef KRS_VIEW_H
#define KRS_VIEW_H

#include "compiler/compile.h"
#include "runtime/krs_vulkan.h"
#include "runtime/shared/blocks.h"

/* Fills in all of `block` but error and most_steps.  False when the camera cannot be used: an
   eye at its target, an angle or a height that is not positive, or anything not finite. */
bool view_prepare(const KrsView *view, const double low[3], const double high[3], uint32_t width,
                  uint32_t height, FrameBlock *block);

/* How wide a pixel in the middle of the picture is at a distance from the eye. */
double view_pixel(const KrsCamera *camera, uint32_t height, double distance);

/* The box that rays are clipped to: this one, a little larger, since surfaces may touch it and
   single precision must not lose them. */
void view_place_box(const KrsView *view, const double low[3], const double high[3],
                    FrameBlock *block);

/* The pixels whose rays may meet the box of the block; of a panorama all. */
KrsWindow view_window(const FrameBlock *block, const KrsCamera *camera);

/* A camera that stands for `count` rays: in the middle of the box around their origins, with that
   box's diagonal as its height.  False when one of them cannot be used. */
bool view_of_rays(const KrsRays *rays, size_t count, KrsCamera *camera);

/* The matrices of a picture, for a camera that view_prepare has accepted; NULL: none, they change
   nothing. */
void view_matrices(const KrsCamera *camera, uint32_t width, uint32_t height, KrsPicture *picture);

#endif
