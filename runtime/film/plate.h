/*
 * plate.h: the plate of another renderer, on which shadows and reflections fall.
 */
#ifndef KRS_PLATE_H
#define KRS_PLATE_H

#include "runtime/film/resident.h"
#include "runtime/tracer/job.h"

/* Tells whether the plate of a film catches shadows. */
bool plate_catches(const KrsFilm *film);
/* Returns the rows of results that are of the plate: 0, 2 or 4. */
uint32_t plate_rows(const KrsFilm *film);
/* Tells the shaders what falls on the plate, and where its rows are. */
void plate_tell(const KrsFilm *film, ControlBlock *control);
/* Writes the planes of the plate in the pixels of a band, four numbers each: the unit normal, and its
   product with the points of the plane. */
void plate_find_planes(const Job *job, const KrsWindow *traced, float (*planes)[4]);
/* Gives a picture of the sums of a film what the plate has caught.  False with the failure noted. */
bool plate_finish(const KrsFilm *film, KrsPicture *picture);

#endif
