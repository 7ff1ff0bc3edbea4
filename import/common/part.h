/*
 * part.h: a scene of another program as a tree of parts, and how it is
 * written.
 */
#ifndef KRS_IMPORT_PART_H
#define KRS_IMPORT_PART_H

#include "import/common/transform.h"

/* The deepest nesting that is read: those who read and write parts call
 * themselves. */
enum { IMPORT_MAX_DEPTH = 200 };

typedef enum PartJoin {
    PART_UNION, /* also of one */
    PART_INTERSECTION,
    PART_DIFFERENCE,
    PART_XOR, /* of two */
    PART_HULL,
    PART_CLIP /* of two: the surface of the first one within the second */
} PartJoin;

/* Points whose convex hull, grown by a radius, a shape is. */
typedef struct PartBalls {
    double (*points)[3]; /* NULL: it is something else */
    size_t  count, capacity;
    double  radius;
    double *radii; /* of each, where they differ; else NULL */
} PartBalls;

/* Tells whether a point is in a simple solid, in its own space. */
typedef struct PartInside {
    enum {
        PART_UNTOLD,     /* it is something else */
        PART_BALL,       /* of the first number, its radius */
        PART_BOX,        /* of half the edges */
        PART_HALF_SPACE, /* of a unit normal and an offset */
        PART_ROUND,      /* of a unit axis, half the height, and the radii at its two ends */
        PART_RING        /* about y, of its radius and that of its tube */
    } kind;
    double numbers[6];
} PartInside;

/* A column upon a figure: from z = -height / 2 to height / 2 in its own space. */
typedef struct PartColumn {
    struct Part *figure; /* NULL: it is something else */
    double       height;
} PartColumn;

/* A round cone about its own z, from -height / 2 to height / 2; a height of 0: it is something else. */
typedef struct PartCone {
    double bottom, top, height;
} PartCone;

/* Its shape, or its items joined; then methods; then its transform; then its look.
 */
typedef struct Part {
    const char *stem;  /* what its name begins with in the scene, and a number behind it */
    const char *shape; /* as the scene has it; NULL: see join and items */
    PartJoin    join;
    struct {
        struct Part **items;
        size_t        count, capacity;
    } parts;
    const char *methods; /* such as ".offset(1)", in the part's own space; NULL: none */
    Transform   transform;
    const char *look;    /* argument of `.paint`; NULL: none */
    bool        figure;  /* plane, in x and y */
    bool        outside; /* it is what is outside of this */
    bool        shared;  /* in several places */
    PartBalls   balls;
    PartColumn  column;
    PartCone    cone;
    PartInside  inside;
    const char *equation; /* "algebraic(...)" or "field(...)", of which the shape is all, or what is
                             within `extent`; NULL: it is something else */
    const char *extent;   /* a region; NULL: the equation alone */
    double      figure_radius; /* of a circle about its own origin; else 0 */
    double (*corners)[3];      /* of a figure with straight sides, in their order, or
                           NULL */
    size_t   corner_count;
    unsigned line;
    /* of the writer */
    const char *wanted;  /* the name that the file has for it */
    const char *name;    /* where it is the same wherever it is */
    int         depth;   /* of parts in it */
    int         painted; /* 0 unknown; PAINTED, UNPAINTED, or both */
} Part;

typedef struct PartWriter {
    Import *import;
    bool    inner_looks; /* a part's own look counts, not that of what it is a part
                       of */
    size_t  written;
} PartWriter;

Part *part_new(Import *import, unsigned line, const char *stem);
Part *part_shape(Import *import, unsigned line, const char *stem, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void part_add(Import *import, Part *part, Part *item);
/* Returns `what`, to which methods are added that see it as it is placed. */
Part *part_around(Import *import, unsigned line, const char *stem, Part *what);
/* Places it anew, behind where it is. */
void part_move(Part *part, const Transform *transform);
/* Tells whether a point is inside, as far as that is told; if not, it counts as outside. */
bool part_holds(const Part *part, const double point[3]);
/* Tells whether all that it is made of has looks; nothing may be added to it after that. */
bool part_is_painted(Part *part);

/* Returns "[1, 2, 3]", "2.5": rounded numbers, to be put into formats. */
const char *import_vector_text(Import *import, const double *numbers, int count);
const char *import_number_text(Import *import, double number);

/* Adds a `let` for the part and all that it needs.  Returns false after a
 * refusal. */
bool part_write(PartWriter *writer, Part *part);
/* Does the same, and then shows it; `methods` are those of the scene as a whole. */
bool part_show(PartWriter *writer, Part *part, const char *methods);

#endif
