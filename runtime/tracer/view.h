/*
 * view.h: from the camera and the sky of a scene to what the shaders need.
 */
#ifndef KRS_VIEW_H
#define KRS_VIEW_H

#include "compiler/passes/compile.h"
#include "krs/vulkan.h"
#include "runtime/shared/blocks.h"

/* Fills in all of `block` but error and max_steps.  False when the camera cannot be used: an
   eye at its target, an angle or a height that is not positive, or anything not finite. */
bool view_prepare(const KrsView *view, const double low[3], const double high[3], uint32_t width,
                  uint32_t height, FrameBlock *block);

/* Returns the distance of a camera's two eyes. */
double view_eyes(const KrsCamera *camera);
/* Moves a camera to one of its two eyes.  Both see what is in focus at the same place of the
   picture.  The eye of a panorama looks a different way with each column, so it is left to
   view_prepare, by `eyes`: then this is half of their distance to the right. */
void view_choose_eye(KrsCamera *camera, KrsEye eye, uint32_t width, uint32_t height);

/* Finds the ray through a place of the picture, from -1 to 1 to the right and upwards, without
   regard to a lens: `direction` has any length.  False for a panorama, and where the camera cannot
   be used. */
bool view_ray(const KrsCamera *camera, uint32_t width, uint32_t height, const double place[2],
              double origin[3], double direction[3]);

/* Returns the width of a pixel in the middle of the picture, at a distance from the eye. */
double view_pixel(const KrsCamera *camera, uint32_t height, double distance);
/* Returns the same of a ray of a list, for which the camera stands; NULL: there is no list. */
double view_width(const KrsCamera *camera, const KrsRays *rays, uint32_t height, double distance);

/* Sets the box that rays are clipped to.  It is a little larger than [low, high], since surfaces
   may touch these sides and single precision must not lose them. */
void view_place_box(const KrsView *view, const double low[3], const double high[3],
                    FrameBlock *block);

/* Returns the pixels whose rays may meet the box of the block, if these go up to `reach` pixels
   from the middle of theirs; for a panorama or a lens all pixels. */
KrsWindow view_window(const FrameBlock *block, const KrsCamera *camera, double reach);

/* Makes a camera in place of `count` rays: in the middle of the box around their origins, with that
   box's diagonal as its height.  False when a ray or its width cannot be used. */
bool view_of_rays(const KrsRays *rays, size_t count, KrsCamera *camera);

/* Sets the matrices of a picture for a camera that view_prepare has accepted; NULL: they are the
   identity. */
void view_matrices(const KrsCamera *camera, uint32_t width, uint32_t height, KrsPicture *picture);

#endif
