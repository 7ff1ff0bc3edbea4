/* blocks.c: copies blocks, collapses their edges, and puts what is left together. */
#include "mesh/simplify/blocks.h"

#include <stdatomic.h>
#include <string.h>

#include "compiler/base/parallel.h"
#include "mesh/common/crossing.h"
#include "mesh/common/numbering.h"

enum { BLOCK = 4096 }; /* triangles */
/* One in so many triangles is left: with fewer, borders are much finer than what they enclose. */
enum { PART = 6 };

typedef struct Blocks {
    const double (*vertices)[3];
    const uint32_t (*triangles)[3], *order;
    size_t               count, block_count;
    const uint32_t      *degrees; /* of vertices: how many triangles have them */
    const CollapseRules *rules;
    uint32_t (*left)[3];
    uint32_t     *left_counts; /* of blocks, whose triangles begin where they began */
    atomic_size_t next;
    atomic_bool   stopped;
} Blocks;

/* A block with numbers of its own. */
typedef struct Block {
    size_t    first, count, vertex_count;
    uint32_t  triangles[BLOCK][3];
    uint32_t  number[3 * BLOCK]; /* of vertices: in the mesh */
    uint32_t  degrees[3 * BLOCK], below[3 * BLOCK];
    double    vertices[3 * BLOCK][3];
    double    off[BLOCK], missed[BLOCK];
    bool      kept[BLOCK], border[3 * BLOCK], stays[3 * BLOCK];
    Numbering numbers;
} Block;

static bool is_wanted(void *user, double part)
{
    const Blocks *b = user;
    (void)part;
    return !atomic_load_explicit(&b->stopped, memory_order_relaxed);
}

static void copy_block(const Blocks *b, Block *block, Arena *arena)
{
    block->vertex_count = 0;
    block->numbers      = (Numbering){.arena = arena};
    memset(block->degrees, 0, sizeof block->degrees);
    for (size_t i = 0; i < block->count; i++) {
        const uint32_t *corners = b->triangles[b->order[block->first + i]];
        for (int c = 0; c < 3; c++) {
            uint32_t fresh = (uint32_t)block->vertex_count;
            uint32_t own   = numbering_take(&block->numbers, (NumberKey){corners[c], 1}, fresh);
            if (own == fresh) {
                block->number[own] = corners[c];
                memcpy(block->vertices[own], b->vertices[corners[c]], sizeof *block->vertices);
                block->vertex_count++;
            }
            block->degrees[own]++;
            block->triangles[i][c] = own;
        }
    }
    memset(block->off, 0, sizeof block->off);
    memset(block->missed, 0, sizeof block->missed);
    for (size_t i = 0; i < block->vertex_count; i++) {
        block->below[i]  = UINT32_MAX;
        block->border[i] = block->degrees[i] != b->degrees[block->number[i]];
    }
}

/* Writes what is left of a block; only blocks that have all triangles of a vertex write what is
   known of it. */
static void write_block(const Blocks *b, const Block *block, size_t left)
{
    const CollapseRules *rules = b->rules;
    for (size_t i = 0; i < left; i++) {
        for (int c = 0; c < 3; c++)
            b->left[block->first + i][c] = block->number[block->triangles[i][c]];
        rules->off[block->first + i]    = block->off[i];
        rules->missed[block->first + i] = block->missed[i];
    }
    for (size_t i = 0; i < block->vertex_count; i++)
        if (block->below[i] != UINT32_MAX)
            rules->below[block->number[i]] = (uint32_t)block->first + block->below[i];
}

/* Marks vertices of triangles that cross others; returns whether there are any. */
static bool find_crossing(Block *block, size_t left, Arena *arena)
{
    Bvh  bvh;
    bool any = false;
    bvh_new(&bvh, (const double(*)[3])block->vertices, (const uint32_t(*)[3])block->triangles, left,
            arena);
    for (uint32_t i = 0; i < left; i++)
        if (triangle_crosses(&bvh, i, 0)) {
            any = true;
            for (int c = 0; c < 3; c++)
                block->stays[block->triangles[i][c]] = true;
        }
    return any;
}

/* Collapses edges until no triangles of the block cross, those of vertices that stay less and less;
   returns how many are left. */
static size_t collapse_without_crossing(Blocks *b, Block *block, Arena *arena)
{
    enum { MAX_TIMES = 6 };
    CollapseRules rules = {.kept      = block->kept,
                           .below     = block->below,
                           .error     = b->rules->error,
                           .off       = block->off,
                           .missed    = block->missed,
                           .is_wanted = is_wanted,
                           .user      = b,
                           .enough    = block->count / PART,
                           .border    = block->border};
    for (int i = 0; i < MAX_TIMES; i++) {
        copy_block(b, block, arena);
        for (size_t k = 0; k < 3 * block->count; k++)
            block->kept[k / 3] = block->kept[k / 3] || block->stays[block->triangles[k / 3][k % 3]];
        size_t left = collapse_edges((const double(*)[3])block->vertices, block->vertex_count,
                                     block->triangles, block->count, &rules, arena);
        if (!find_crossing(block, left, arena))
            return left;
    }
    copy_block(b, block, arena);
    return block->count;
}

static void collapse_block(Blocks *b, size_t number, Arena *arena)
{
    Block *block           = arena_new(arena, Block);
    block->first           = number * BLOCK;
    block->count           = b->count - block->first < BLOCK ? b->count - block->first : BLOCK;
    size_t left            = collapse_without_crossing(b, block, arena);
    b->left_counts[number] = (uint32_t)left;
    write_block(b, block, left);
}

/* Takes blocks until none is left; the first part reports progress, since it runs in the caller's
   thread.  Memory is of the thread's own; without, nothing is left of the work. */
static void collapse_some(void *task, size_t part, size_t parts)
{
    Blocks *b = task;
    jmp_buf exhausted;
    Memory  memory = {.exhausted = &exhausted};
    Arena   arena  = {.memory = &memory};
    (void)parts;
    if (setjmp(exhausted) != 0)
        atomic_store(&b->stopped, true);
    while (!atomic_load(&b->stopped)) {
        size_t next = atomic_fetch_add(&b->next, 1);
        if (next >= b->block_count)
            break;
        if (part == 0 &&
            !b->rules->is_wanted(b->rules->user, (double)next / (double)b->block_count))
            atomic_store(&b->stopped, true);
        collapse_block(b, next, &arena);
        arena_clear(&arena);
    }
    arena_free(&arena);
}

/* Moves what is left of blocks together; returns how much it is. */
static size_t join_blocks(const Blocks *b, size_t vertex_count)
{
    size_t    left   = 0;
    uint32_t *begins = b->left_counts; /* how far blocks are moved, in place of how many are left */
    for (size_t i = 0; i < b->block_count; i++) {
        size_t count = b->left_counts[i], first = i * BLOCK;
        memmove(b->left[left], b->left[first], count * sizeof *b->left);
        memmove(b->rules->off + left, b->rules->off + first, count * sizeof(double));
        memmove(b->rules->missed + left, b->rules->missed + first, count * sizeof(double));
        begins[i] = (uint32_t)(first - left);
        left += count;
    }
    for (size_t i = 0; i < vertex_count; i++)
        if (b->rules->below[i] != UINT32_MAX)
            b->rules->below[i] -= begins[b->rules->below[i] / BLOCK];
    return left;
}

size_t collapse_blocks(const double (*vertices)[3], size_t    vertex_count,
                       const uint32_t (*triangles)[3], size_t count, const uint32_t *order,
                       const CollapseRules *rules, uint32_t (*left)[3], Arena *arena)
{
    ArenaMark mark   = arena_mark(arena);
    size_t    blocks = (count + BLOCK - 1) / BLOCK, all = 0;
    uint32_t *degrees = arena_new_array(arena, uint32_t, vertex_count + 1);
    Blocks    b       = {.vertices    = vertices,
                         .triangles   = triangles,
                         .order       = order,
                         .count       = count,
                         .block_count = blocks,
                         .degrees     = degrees,
                         .rules       = rules,
                         .left        = left,
                         .left_counts = arena_new_array(arena, uint32_t, blocks + 1)};
    for (size_t i = 0; i < 3 * count; i++)
        degrees[triangles[i / 3][i % 3]]++;
    for (size_t i = 0; i < vertex_count; i++)
        rules->below[i] = UINT32_MAX;
    run_in_parallel(collapse_some, &b);
    if (!atomic_load(&b.stopped))
        all = join_blocks(&b, vertex_count);
    arena_rewind(arena, mark);
    return all;
}
