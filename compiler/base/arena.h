/*
 * arena.h: memory that is freed all at once.
 *
 * The compiler has an arena for each lifetime (compilation.h).  Single objects are not freed, but
 * for large ones, and for all since a mark.  Memory is zeroed.  When it runs out, longjmp returns to
 * the function of the library that the user called.  That function reports it, so no caller in
 * between checks for NULL.
 */
#ifndef KRS_ARENA_H
#define KRS_ARENA_H

#include <setjmp.h>
#include <stdbool.h>
#include <stddef.h>

/* The memory that arenas get their blocks from, shared by all arenas of one compilation. */
typedef struct Memory {
    void *(*allocate)(void *user, size_t size); /* NULL means malloc */
    void (*release)(void *user, void *block);   /* NULL means free */
    void    *user;
    size_t   used;      /* bytes now held */
    size_t   limit;     /* most bytes that may be held; 0 means no limit */
    jmp_buf *exhausted; /* target of longjmp when memory runs out; set before any allocation */
} Memory;

typedef struct Arena {
    Memory            *memory;
    struct ArenaBlock *newest; /* blocks, newest first */
    char              *next;   /* first free byte of the newest block */
    size_t             left;   /* free bytes there */
} Arena;

/* Objects are put together in blocks of at most this size. */
enum { LARGEST_BLOCK_BYTES = 1 << 20 };

/* Returns count * size zeroed bytes, aligned for any object; never NULL.  If the product overflows,
   memory has run out. */
void *arena_alloc(Arena *arena, size_t count, size_t size);

/* Frees all blocks; the arena can be used again. */
void arena_free(Arena *arena);
/* Does the same, but keeps a small block for what follows, for arenas that are used for one thing after
   the other. */
void arena_clear(Arena *arena);

/* A place in an arena; what was allocated since can be freed again.  Marks are rewound in the
   reverse order. */
typedef struct ArenaMark {
    struct ArenaBlock *newest, *behind;
    char              *next;
    size_t             left;
} ArenaMark;
ArenaMark arena_mark(const Arena *arena);
void      arena_rewind(Arena *arena, ArenaMark mark);

/* Returns a copy of length bytes, with a NUL behind them. */
char *arena_copy_text(Arena *arena, const char *bytes, size_t length);

/* Ends as an arena does whose memory runs out, for callers that find that elsewhere. */
_Noreturn void arena_exhausted(const Arena *arena);

/* A new T, or an array of n of them: Token *t = arena_new(arena, Token); */
#define arena_new(arena, T)          ((T *)arena_alloc((arena), 1, sizeof(T)))
#define arena_new_array(arena, T, n) ((T *)arena_alloc((arena), (n), sizeof(T)))

/* Returns a larger copy of a full array, for array_push.  The old array stays in the arena. */
void *arena_grow(Arena *arena, void *items, size_t count, size_t *capacity, size_t size);

/* Frees an object of at least LARGEST_BLOCK_BYTES that nothing refers to any more, such as an array
   that was copied to a larger one; smaller objects stay. */
void arena_release(Arena *arena, void *object, size_t bytes);

/* Growing arrays are structs with these three members, in the arena given at each push:
       typedef struct { Token *items; size_t count, capacity; } Tokens;
       array_push(arena, &tokens, token);                                                     */
#define array_push(arena, array, item)                                                     \
    ((array)->count == (array)->capacity                                                   \
         ? (void)((array)->items = arena_grow((arena), (array)->items, (array)->count,     \
                                              &(array)->capacity, sizeof *(array)->items)) \
         : (void)0,                                                                        \
     (void)((array)->items[(array)->count++] = (item)))

/* Makes room for one more item in an array that may be large, and into which nothing points: the old
   copy is freed.  It is for items that cannot be assigned, as rows of numbers. */
#define array_reserve_large(arena, array)                                                  \
    do {                                                                                   \
        size_t before_ = (array)->capacity * sizeof *(array)->items;                       \
        void  *old_    = (array)->items;                                                   \
        if ((array)->count == (array)->capacity) {                                         \
            (array)->items = arena_grow((arena), old_, (array)->count, &(array)->capacity, \
                                        sizeof *(array)->items);                           \
            arena_release(arena, old_, before_);                                           \
        }                                                                                  \
    } while (0)

/* Does what array_push does to such an array; the item does not stand in it. */
#define array_push_large(arena, array, item)       \
    do {                                           \
        array_reserve_large(arena, array);         \
        (array)->items[(array)->count++] = (item); \
    } while (0)

#endif
