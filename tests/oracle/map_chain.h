/*
 * map_chain.h: random sequences of kernels, mirrors and conformal maps, and what they mean for
 * points.
 *
 * Inversions are done by their definition, one elementary map after the other, and nothing here
 * knows a bound.  A point is inside when the statements, undone one by one, bring it into a kernel;
 * a cloud is made by applying every statement to every point.
 */
#ifndef ORACLE_MAP_CHAIN_H
#define ORACLE_MAP_CHAIN_H

#include "tests/oracle/brute.h"
#include "tests/oracle/product.h"

/* ---- elementary maps ---- */

typedef struct Elementary {
    enum { TRANSLATE, ROTATE, SCALE, REFLECT, INVERT } kind;
    Vec    vector; /* way, axis, normal or centre */
    double number; /* angle, factor, offset or radius */
} Elementary;

/* Applied from the first to the last. */
typedef struct Word {
    Elementary letters[6];
    int        count;
} Word;

void word_add(Word *word, int kind, Vec vector, double number);
Vec  elementary_apply(const Elementary *l, Vec p, bool undo);
Vec  word_apply(const Word *word, Vec p);
void write_word(SceneText *text, const Word *word);

/* ---- sequences ---- */

/* The points within `radius` of a segment, or a turned box; or the set of another sequence. */
typedef struct Kernel {
    const struct Chain *chain;
    bool                box;
    Vec                 from, to, sides, axis;
    double              angle, radius;
    Word                placed;
} Kernel;

typedef struct Statement {
    enum { KERNEL, MIRROR, MAP } kind;
    Kernel kernel;
    Half   mirror;
    Word   map;
} Statement;

enum { MAX_STATEMENTS = 40 };

typedef struct Chain {
    Statement statements[MAX_STATEMENTS];
    int       count, mirrors;
} Chain;

/* What is nearest by the distance without the bound, d over the scale of the maps. */
typedef struct Nearest {
    double   naive;
    uint32_t level, id; /* of the outermost sequence */
} Nearest;

double naive_distance(const Chain *chain, Vec p, double scale, Nearest *nearest);

/* Tells whether a point is inside; `chain` is a Chain. */
bool map_chain_contains(const void *chain, Vec p);

/* Points of the surface, so many of each kernel. */
Cloud chain_cloud(const Chain *chain, int each, Random *random);

/* Returns a point near one of a cloud. */
Vec     random_near(const Cloud *cloud, Random *random);
Product compile_chain(const Chain *chain);

/* ---- random sequences ---- */

typedef struct Flavour {
    const char *name;
    int         levels, chains;
    double      near, far; /* how far poles are from the origin, about which the set is */
    double      inverting; /* the share of maps that invert; the rest are similarities */
    bool        mirrors, nested, placed;
    uint64_t    seed;
} Flavour;

enum { FLAVOURS = 11 };
extern const Flavour flavours[FLAVOURS];

/* `inner`: what may be a kernel of a nested one, or NULL. */
/* Returns the chain that a kernel stands for when `inner` is one. */
Chain random_chain(const Flavour *flavour, const Chain *inner, Random *random);

#endif
