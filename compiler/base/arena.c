/*
 * arena.c: memory that is freed all at once, taken from the system in blocks.
 *
 * With -DKRS_ARENA_SEPARATE each object is a block of its own, so that the address sanitizer
 * detects a write past its end.
 */
#include "compiler/base/arena.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/pages.h"

enum { FIRST_BLOCK_BYTES = 4096 };

typedef struct ArenaBlock {
    struct ArenaBlock *older;
    size_t             size; /* with this header */
} ArenaBlock;

enum {
    ALIGNMENT    = _Alignof(max_align_t),
    HEADER_BYTES = (sizeof(ArenaBlock) + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT
};

static _Noreturn void out_of_memory(const Memory *memory) { longjmp(*memory->exhausted, 1); }

_Noreturn void arena_exhausted(const Arena *arena) { out_of_memory(arena->memory); }

/* Returns a zeroed block with space for `bytes` behind its header.  The caller links it into a
   list. */
static ArenaBlock *block_new(Memory *memory, size_t bytes)
{
    if (bytes > SIZE_MAX - HEADER_BYTES)
        out_of_memory(memory);
    size_t size = bytes + HEADER_BYTES;
    if (memory->limit != 0 && (memory->used > memory->limit || size > memory->limit - memory->used))
        out_of_memory(memory);
    /* A block from the system that was never used is zero: calloc touches nothing of it. */
    ArenaBlock *block = memory->allocate ? memory->allocate(memory->user, size) : calloc(1, size);
    if (!block)
        out_of_memory(memory);
    if (memory->allocate)
        memset(block, 0, size);
    else
        pages_enlarge(block, size);
    block->size = size;
    memory->used += size;
    return block;
}

static void *block_bytes(ArenaBlock *block) { return (char *)block + HEADER_BYTES; }

#ifdef KRS_ARENA_SEPARATE

static void *allocate(Arena *arena, size_t bytes)
{
    ArenaBlock *block = block_new(arena->memory, bytes);
    block->older      = arena->newest;
    arena->newest     = block;
    return block_bytes(block);
}

#else

/* Takes an object from a new block.  Each block is twice as large as the one before, up to a
   limit. */
static void *take_from_new_block(Arena *arena, size_t bytes)
{
    size_t capacity = FIRST_BLOCK_BYTES;
    if (arena->newest)
        capacity = arena->newest->size < LARGEST_BLOCK_BYTES ? 2 * arena->newest->size
                                                             : LARGEST_BLOCK_BYTES;
    capacity -= HEADER_BYTES;
    ArenaBlock *block = block_new(arena->memory, bytes > capacity ? bytes : capacity);
    if (bytes > capacity / 4 && arena->newest) {
        /* A large object has a block of its own, listed behind the newest one, so that the free
           bytes of the newest block can still be used. */
        block->older         = arena->newest->older;
        arena->newest->older = block;
        return block_bytes(block);
    }
    block->older  = arena->newest;
    arena->newest = block;
    arena->next   = (char *)block_bytes(block) + bytes;
    arena->left   = block->size - HEADER_BYTES - bytes;
    return block_bytes(block);
}

static void *allocate(Arena *arena, size_t bytes)
{
    if (bytes > SIZE_MAX - ALIGNMENT)
        out_of_memory(arena->memory);
    bytes = (bytes + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    if (bytes == 0)
        bytes = ALIGNMENT; /* so that objects of size 0 have different addresses */
    if (bytes > arena->left)
        return take_from_new_block(arena, bytes);
    char *object = arena->next;
    arena->next += bytes;
    arena->left -= bytes;
    return object;
}

#endif

void *arena_alloc(Arena *arena, size_t count, size_t size)
{
    if (size != 0 && count > SIZE_MAX / size)
        out_of_memory(arena->memory);
    return allocate(arena, count * size);
}

static void block_free(Memory *memory, ArenaBlock *block)
{
    memory->used -= block->size;
    if (memory->release)
        memory->release(memory->user, block);
    else
        free(block);
}

static void free_until(Memory *memory, ArenaBlock **newest, const ArenaBlock *last)
{
    while (*newest != last) {
        ArenaBlock *block = *newest;
        *newest           = block->older;
        block_free(memory, block);
    }
}

void arena_free(Arena *arena)
{
    free_until(arena->memory, &arena->newest, NULL);
    arena->next = NULL;
    arena->left = 0;
}

#ifdef KRS_ARENA_SEPARATE

void arena_clear(Arena *arena) { arena_free(arena); }

#else

/* The oldest block is the smallest as a rule. */
void arena_clear(Arena *arena)
{
    ArenaBlock *first = arena->newest;
    while (first && first->older)
        first = first->older;
    if (!first || first->size > FIRST_BLOCK_BYTES) {
        arena_free(arena);
        return;
    }
    const size_t all  = first->size - HEADER_BYTES;
    const bool   only = arena->newest == first;
    memset(block_bytes(first), 0, only ? all - arena->left : all);
    free_until(arena->memory, &arena->newest, first);
    arena->next = block_bytes(first);
    arena->left = all;
}

#endif

ArenaMark arena_mark(const Arena *arena)
{
    return (ArenaMark){arena->newest, arena->newest ? arena->newest->older : NULL, arena->next,
                       arena->left};
}

/* Frees what was allocated since a mark.  Large objects are listed behind the block that was the
   newest one. */
void arena_rewind(Arena *arena, ArenaMark mark)
{
    bool   same = arena->newest == mark.newest;
    size_t used = same ? (size_t)(arena->next - mark.next) : mark.left;
    free_until(arena->memory, &arena->newest, mark.newest);
    if (mark.newest)
        free_until(arena->memory, &mark.newest->older, mark.behind);
    if (used > 0)
        memset(mark.next, 0, used);
    arena->next = mark.next;
    arena->left = mark.left;
}

/* An object of this size has a block of its own.  The newest block stays: objects may follow. */
void arena_release(Arena *arena, void *object, size_t bytes)
{
    if (bytes < LARGEST_BLOCK_BYTES)
        return;
    for (ArenaBlock *newer = arena->newest; newer->older; newer = newer->older) {
        ArenaBlock *block = newer->older;
        if (block_bytes(block) != object)
            continue;
        newer->older = block->older;
        block_free(arena->memory, block);
        return;
    }
}

char *arena_copy_text(Arena *arena, const char *bytes, size_t length)
{
    if (length == SIZE_MAX)
        out_of_memory(arena->memory);
    char *copy = arena_alloc(arena, length + 1, 1);
    if (length > 0)
        memcpy(copy, bytes, length);
    return copy;
}

/* The system has given no memory yet for what is never touched, so that larger steps cost nothing
   there, and less is copied. */
static bool is_large(size_t capacity, size_t size)
{
    enum { LARGE = 1 << 20, MOST = 16 << 20 };
    return capacity >= LARGE / size && capacity < MOST / size;
}

void *arena_grow(Arena *arena, void *items, size_t count, size_t *capacity, size_t size)
{
    if (*capacity > SIZE_MAX / 4)
        out_of_memory(arena->memory);
    const size_t times  = is_large(*capacity, size) ? 4 : 2;
    size_t       larger = *capacity < 4 ? 8 : times * *capacity;
    void        *grown  = arena_alloc(arena, larger, size);
    if (count > 0)
        memcpy(grown, items, count * size);
    *capacity = larger;
    return grown;
}
