/*
 * framing.h: a camera for a scene that has none.
 */
#ifndef KRS_FRAMING_H
#define KRS_FRAMING_H

#include "compiler/program.h"

/* Eye and target of the default camera (its direction and field of view stay) from what rays
   find of the bounded components at the default parameters; nothing changes when they find
   nothing.  KRS_OUT_OF_MEMORY. */
KrsStatus frame_scene(KrsScene *scene);

#endif
