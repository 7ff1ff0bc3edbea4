/*
 * cryptomatte.h: mattes as Cryptomatte 1.2 has them: channels of identifiers and shares of each
 * pixel, and what tells their names.
 */
#ifndef KRS_CLI_CRYPTOMATTE_H
#define KRS_CLI_CRYPTOMATTE_H

#include "cli/shell/commands.h"
#include "runtime/writer/picture.h"

enum { MATTE_CHANNELS = KRS_MATTE_COUNT * 2 * KRS_MATTE_RANKS, MATTE_TEXTS = KRS_MATTE_COUNT * 4 };

/* Returns the 32-bit MurmurHash3 of a text, without a seed. */
uint32_t murmur_hash(const char *text);
/* Returns the bits of a float that is neither infinite nor denormal. */
uint32_t matte_identifier(uint32_t hash);

typedef struct Cryptomatte {
    float         *values; /* of all channels, for free() */
    PictureChannel channels[MATTE_CHANNELS];
    PictureText    texts[MATTE_TEXTS];
} Cryptomatte;

/* Makes channels and texts of the mattes of a picture, which must have some; false: out of memory. */
bool cryptomatte_make(Arena *arena, const KrsPicture *picture, const KrsScene *scene,
                      Cryptomatte *matte);

#endif
