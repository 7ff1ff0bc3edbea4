/*
 * film.h: the part of vulkan.h that is about films which are kept; it is included there.
 */
#ifndef KRS_FILM_H
#define KRS_FILM_H

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__
#pragma GCC visibility push(default)
#endif

/* Take or give the next `size` bytes of a film that is kept; false: they cannot. */
typedef bool KrsWriteCallback(void *user, const void *bytes, size_t size);
typedef bool KrsReadCallback(void *user, void *bytes, size_t size);

/*
 * Writes all that a film has, so that another process on this machine can go on: krs_film_load gives
 * it to a film with the same options, of a rendering of the same scene on the same device.  Samples
 * that are added then make the picture that they would have made here, bit by bit.
 *
 * KRS_IO_ERROR: `write` returned false; KRS_BAD_ARGUMENT: there is no sample; KRS_OUT_OF_MEMORY,
 * KRS_INTERNAL.
 */
KrsStatus krs_film_save(KrsFilm *film, KrsWriteCallback *write, void *user);

/*
 * Replaces all samples of a film by those that were saved.  Who calls it sees to it that the bytes are
 * those that were written, by a sum of them as in a file of `krs render --resume`.
 *
 * On any status but KRS_OK the film has no sample.  KRS_IO_ERROR: `read` returned false;
 * KRS_BAD_ARGUMENT: what was saved is of a krs of other sources, or of a film with other AOVs, size
 * or crop.
 */
KrsStatus krs_film_load(KrsFilm *film, KrsReadCallback *read, void *user);

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif
#endif
