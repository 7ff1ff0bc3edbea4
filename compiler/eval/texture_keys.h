/*
 * texture_keys.h: the textures that a scene has named so far.
 */
#ifndef KRS_TEXTURE_KEYS_H
#define KRS_TEXTURE_KEYS_H

#include <stdint.h>

#include "compiler/base/arena.h"

/* The properties by which textures differ. */
typedef struct TextureKey {
    const char *path;
    uint32_t    wrap, space;
} TextureKey;

/* The keys of textures, in the order of Graph.textures. */
typedef struct TextureKeys {
    TextureKey *items;
    size_t      count, capacity;
    Arena      *arena; /* of the compiled scene, for the textures */
} TextureKeys;

#endif
