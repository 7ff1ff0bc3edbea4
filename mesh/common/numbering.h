/*
 * numbering.h: numbers of edges, faces and points, found by what they are made of.
 */
#ifndef KRS_MESH_NUMBERING_H
#define KRS_MESH_NUMBERING_H

#include "compiler/base/arena.h"

#include <stdint.h>

typedef struct NumberKey {
    uint64_t a, b;
} NumberKey;

typedef struct NumberSlot {
    NumberKey key;
    uint32_t  value; /* number + 1; 0 is free */
} NumberSlot;

/* Open addressing; the size is a power of 2, at most half is full. */
typedef struct Numbering {
    Arena      *arena;
    NumberSlot *slots;
    size_t      size, count;
} Numbering;

#define NO_NUMBER UINT32_MAX

/* Returns the number of a key, or NO_NUMBER. */
uint32_t numbering_find(const Numbering *numbering, NumberKey key);
/* Returns the number of a key; a new key gets the number `fresh`. */
uint32_t numbering_take(Numbering *numbering, NumberKey key, uint32_t fresh);

/* Return keys of two or three different numbers, whatever their order. */
NumberKey edge_key(uint32_t a, uint32_t b);
NumberKey face_key(uint32_t a, uint32_t b, uint32_t c);

#endif
