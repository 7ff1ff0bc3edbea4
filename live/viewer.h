/*
 * viewer.h: `krs view`: a window on a scene that is being written.
 */
#ifndef KRS_VIEWER_H
#define KRS_VIEWER_H

#include "live/viewer_options.h"

/* Shows a window until it is closed.  On any status but KRS_OK `message` is one line; KRS_NO_DEVICE:
   there is no display, or nothing to render with. */
KrsStatus viewer_run(const ViewerOptions *options, char message[256]);

#endif
