/*
 * triangles.h: the time of a ray against the number of triangles that the scene would be: the table
 * in section 8 of the KRS paper of 2014.
 */
#ifndef KRS_BENCH_TRIANGLES_H
#define KRS_BENCH_TRIANGLES_H

#include "bench/bench.h"
#include "bench/measure.h"

enum { MAX_EQUIVALENTS = 12 };

/* What a branch or a piece of terrain is counted as, in doublings: the 2016 paper counts hundreds
   of triangles a branch (section 11); a facet of the terrain is two. */
#define BRANCH_DOUBLINGS 8
#define FACET_DOUBLINGS  1

typedef enum Growing { GROWING_TREE, GROWING_TERRAIN, GROWING_COUNT } Growing;
extern const char *const growing_names[GROWING_COUNT];

typedef struct TriangleRow {
    uint32_t doublings;               /* 2 to the power of this many triangles */
    double   paper_us[GROWING_COUNT]; /* a ray, complex and simple shaders; NAN: none */
} TriangleRow;
extern const TriangleRow triangle_rows[];

typedef struct Triangles {
    size_t count;
    double ns_per_ray[GROWING_COUNT][MAX_EQUIVALENTS];       /* NAN: left out */
    Line   lines[GROWING_COUNT], paper_lines[GROWING_COUNT]; /* ns, by doublings; theirs in us */
} Triangles;

void triangles_run(Bench *bench, Triangles *triangles);

#endif
