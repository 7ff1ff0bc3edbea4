/*
 * lights.h: films and pictures in which the light of each light is by itself.
 */
#ifndef KRS_LIGHTS_H
#define KRS_LIGHTS_H

#include "runtime/film/resident.h"

/* Tells how many numbers of four members the light of all lights is. */
size_t lights_numbers(const KrsFilm *film);
/* Makes room for the light of each light of a film's scene, in place of what there was; none where
   the options do not ask for it.  False with the failure noted. */
bool lights_make(KrsFilm *film);
/* Gives a picture of the sums of a film the means of the light of each light, and adds their sums to
   its colours.  False with the failure noted. */
bool lights_finish(const KrsFilm *film, KrsPicture *picture);

#endif
