/* numbering.c: a hash table of numbers. */
#include "mesh/common/numbering.h"

#include <string.h>

static size_t first_slot(const Numbering *numbering, NumberKey key)
{
    uint64_t mixed = (key.a ^ key.b * 0x9E3779B97F4A7C15u) * 0xBF58476D1CE4E5B9u;
    return (size_t)(mixed ^ mixed >> 32) & (numbering->size - 1);
}

static NumberSlot *find_slot(const Numbering *numbering, NumberKey key)
{
    size_t i = first_slot(numbering, key);
    while (numbering->slots[i].value &&
           (numbering->slots[i].key.a != key.a || numbering->slots[i].key.b != key.b))
        i = (i + 1) & (numbering->size - 1);
    return &numbering->slots[i];
}

uint32_t numbering_find(const Numbering *numbering, NumberKey key)
{
    return numbering->size ? find_slot(numbering, key)->value - 1 : NO_NUMBER;
}

static void numbering_grow(Numbering *numbering)
{
    Numbering old    = *numbering;
    numbering->size  = old.size ? 2 * old.size : 1024;
    numbering->slots = arena_new_array(numbering->arena, NumberSlot, numbering->size);
    for (size_t i = 0; i < old.size; i++)
        if (old.slots[i].value)
            *find_slot(numbering, old.slots[i].key) = old.slots[i];
    if (old.slots)
        arena_release(numbering->arena, old.slots, old.size * sizeof *old.slots);
}

uint32_t numbering_take(Numbering *numbering, NumberKey key, uint32_t fresh)
{
    if (2 * (numbering->count + 1) > numbering->size)
        numbering_grow(numbering);
    NumberSlot *slot = find_slot(numbering, key);
    if (!slot->value) {
        *slot = (NumberSlot){key, fresh + 1};
        numbering->count++;
    }
    return slot->value - 1;
}

static void swap_to_order(uint32_t *a, uint32_t *b)
{
    uint32_t lesser = *a < *b ? *a : *b, greater = *a < *b ? *b : *a;
    *a = lesser;
    *b = greater;
}

NumberKey edge_key(uint32_t a, uint32_t b)
{
    swap_to_order(&a, &b);
    return (NumberKey){(uint64_t)a << 32 | b, 0};
}

NumberKey face_key(uint32_t a, uint32_t b, uint32_t c)
{
    swap_to_order(&a, &b);
    swap_to_order(&b, &c);
    swap_to_order(&a, &b);
    return (NumberKey){(uint64_t)a << 32 | b, (uint64_t)c + 1};
}
