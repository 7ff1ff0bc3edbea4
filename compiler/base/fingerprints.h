/*
 * fingerprints.h: what sources this program was built of, as far as they decide what is kept for
 * a later run.  The build writes them: tools/fingerprints.mk says which sources those are.
 *
 * Each is a text of 16 digits.  Whoever keeps something puts the fingerprint into its key, so what
 * another program has kept is not found, and nobody has to raise a number.
 */
#ifndef KRS_FINGERPRINTS_H
#define KRS_FINGERPRINTS_H

extern const char fingerprint_cache[17]; /* compiled shaders, and what else the cache has */
extern const char fingerprint_film[17];  /* the sums of a film's samples */
extern const char
    fingerprint_checkpoint[17]; /* a picture that `krs render --resume` goes on with */

#endif
