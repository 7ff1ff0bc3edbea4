/*
 * whole.h: whether a file is a picture to its end.
 */
#ifndef KRS_WHOLE_H
#define KRS_WHOLE_H

#include <stdbool.h>

/* Tells whether a file is there whose name ends in .exr or .png, and is such a picture from its first byte to its last:
   what others have begun, emptied or cut off is none.  Pixels are not decoded. */
bool picture_is_whole(const char *path);

#endif
