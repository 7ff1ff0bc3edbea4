/*
 * near_slots.h: hash tables in which entries that are made one after the other are near each other.
 *
 * Most expressions are made of some that were made just before.  So an entry that is made of others
 * is looked for in the line of the latest of these first: slots that are neighbours in memory, and
 * mostly in the cache.  Where that line is full the entry is in the first free slot from the place
 * of its hash on.  At most half of the slots are taken; their number is a power of 2.
 */
#ifndef KRS_NEAR_SLOTS_H
#define KRS_NEAR_SLOTS_H

#include <stddef.h>
#include <stdint.h>

/* A table that is full becomes so many times as large: what is put into a larger one again is a third
   of what there is at last. */
enum { SLOTS_OF_LINE = 8, MIN_SLOTS = 64, SLOTS_GROWTH = 4 };

/* A look at the hash is cheaper than one at the entry. */
typedef struct NearSlot {
    uint32_t hash, number; /* of the entry, and 1 more; 0: the slot is free */
} NearSlot;

typedef struct NearSlots {
    NearSlot *items;
    size_t    count;
} NearSlots;

/* Returns the slot that is looked at after `steps` others, for an entry whose latest part is
   `near`. */
static inline NearSlot *near_slot(const NearSlots *slots, uint32_t near, uint32_t hash,
                                  size_t steps)
{
    const size_t line = (size_t)near / (SLOTS_OF_LINE / 2) * SLOTS_OF_LINE;
    const size_t at   = steps < SLOTS_OF_LINE ? line + steps : hash + (steps - SLOTS_OF_LINE);
    return &slots->items[at & (slots->count - 1)];
}

/* Returns the first free slot for an entry that is not in the table. */
static inline NearSlot *near_slot_free(const NearSlots *slots, uint32_t near, uint32_t hash)
{
    size_t steps = 0;
    while (near_slot(slots, near, hash, steps)->number)
        steps++;
    return near_slot(slots, near, hash, steps);
}

#endif
