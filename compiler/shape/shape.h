/*
 * shape.h: what a shape is.
 *
 * Shapes are made by the functions of family.h, bottom up; each knows at once its bounding box and
 * how steep its distance is, by the rule of its kind.  Numbers in it are nodes of the graph
 * that do not depend on the point, so a parameter can move everything.  Shapes never change.
 */
#ifndef KRS_SHAPE_H
#define KRS_SHAPE_H

#include "compiler/base/source.h"
#include "compiler/graph/symbolic/zeros.h"
#include "compiler/shape/box.h"

typedef struct Shape Shape;
typedef struct Map   Map;

/* The reason why the slope of an expression has no bound: a place of the text, and an operation. */
typedef struct Blame {
    Span span;
    Op   op;
} Blame;

/* The material of a surface: a member for each property (surface.def).  Numbers are nodes, colours
   linear VEC3 nodes; NODE_NONE leaves what it was painted with before. */
typedef struct Material {
    const char *name;
    uint32_t number; /* of the name among those of the scene, from 1; 0: it only changes another */
#define KRS_MATERIAL(name, type, otherwise, nothing, low, high, asked, blends) Node name;
#include "krs/surface.def"
    Node bump; /* a height of the surface, as light sees it; or NODE_NONE */
} Material;

typedef enum ShapeKind {
#define SHAPE(KIND, ...) SHAPE_##KIND,
#include "compiler/shape/shapes.def"
    SHAPE_COUNT
} ShapeKind;

/* The part of its operands that a kind leaves. */
typedef enum Leaves { LEAVES_UNKNOWN, LEAVES_ALL, LEAVES_SOME, LEAVES_MIRRORED } Leaves;

/* The properties of all shapes of a kind, as its row of shapes.def says them. */
typedef struct ShapeInfo {
    const char *name, *rule;
    int         parts; /* or SEVERAL */
    bool        divided, own;
    Leaves      leaves;
    bool (*curved)(const Shape *shape);
} ShapeInfo;
extern const ShapeInfo shape_info[SHAPE_COUNT];

enum { SEVERAL = -1 };

/*
 * A conformal map of space: the similarity x -> scale * rows * x + shift or, with a pole,
 * x -> scale * rows * (x - pole) / |x - pole|^2 + shift; rows orthonormal, scale > 0.  Products
 * are one map again, except of inversions whose poles may come too near to each other: those
 * stay separate, and `first` is what is applied before.
 */
struct Map {
    Node       scale, rows[3], shift;
    Node       pole;  /* NODE_NONE: a similarity */
    const Map *first; /* NULL: nothing; similarities have none */
};

/* The ways to join two distances; graph/blends.def has a row for each. */
typedef enum BlendKind {
#define BLEND(name, ...) BLEND_##name,
#include "compiler/graph/blends.def"
    BLEND_COUNT
} BlendKind;

typedef struct BlendInfo {
    const char *spelling;
    Op          op;    /* smooth minimum of (a, b, width) or (a, b, width, steps) */
    double      slope; /* slope of the result over the larger slope of the operands */
    double      bulge; /* how far min(a, b) may exceed a result of 0, in widths */
    double      most;  /* the same for any number of operands */
} BlendInfo;
extern const BlendInfo blend_info[BLEND_COUNT];
/* The result of a kind of blend for more than two operands (blends.def). */
typedef struct BlendMany {
    enum { MANY_PAIRS, MANY_SHARE, MANY_IN_ROW } way;
    Op of_four, of_eight; /* SHARE: operations on distances in vectors */
} BlendMany;
BlendMany blend_many(BlendKind kind);
/* Tell for so many operands, in widths, how far the least may exceed a result of 0, and how far
   above a result an operand no longer changes it. */
double blend_bulge(BlendKind kind, uint32_t count);
double blend_reach(BlendKind kind, double n);
/* Tells how far above the least of the others one of them changes nothing. */
double blend_acts(BlendKind kind, double n);
/* Tells whether what an operand adds falls by e with each width. */
bool blend_fades(BlendKind kind);

/* The ways in which shapes of a metasurface fade; falloffs.def has a row for each. */
typedef enum FalloffKind {
#define FALLOFF(name, spelling, steepest, meaning) FALLOFF_##name,
#include "compiler/shape/falloffs.def"
#undef FALLOFF
    FALLOFF_COUNT
} FalloffKind;

typedef struct Blend {
    BlendKind kind;
    Node      width;  /* NODE_NONE: the CSG node is sharp */
    double    widest; /* for all values of the parameters */
    Node      steps;  /* of kinds that have some */
} Blend;
extern const Blend blend_sharp;

/* One statement of a `krs` block. */
typedef struct SequenceStage {
    enum { SEQUENCE_KERNEL, SEQUENCE_REFLECT, SEQUENCE_SPHERE, SEQUENCE_MAP } kind;
    uint32_t kernel;         /* KERNEL: index of the child */
    Node     normal, offset; /* REFLECT: unit normal and offset of a plane */
    Node     centre, radius; /* SPHERE: of a mirror that is a sphere */
    Map      map;            /* MAP, without `first` */
    Span     span;
} SequenceStage;

/* Around all that the stages of a sequence up to one have made, where that one leaves it. */
typedef struct LevelBound {
    Box  box;
    Ball ball; /* may be the tighter of the two */
} LevelBound;

/* The facts about the formula of a field, or of a primitive whose slope was derived. */
typedef struct FieldFacts {
    Box      region; /* over which its slope was derived; infinite: over all space */
    uint32_t degree; /* of a formula that is a polynomial, else 0, */
    ZeroBox  zeros;  /* and where that may be 0 */
    Blame    blame;  /* what a field without a bound owes that to */
} FieldFacts;

/* Each is about a quarter turn. */
enum { MAX_BEND_SEGMENTS = 16 };

/* Walks of the tree are recursive. */
enum { MAX_SHAPE_DEPTH = 1000 };
/* Walks visit a shape as often as it is used, which is more often than there are shapes. */
enum { MAX_TREE_SHAPES = 4000000 };

/* A corner of a figure's outline, [x, y], and the bulge of the arc from there to the next: the tangent of
   a quarter of its angle, above 0 to the left.  A number is a node unless that is NODE_NONE. */
typedef struct BorderCorner {
    double numbers[3];
    Node   nodes[3];
} BorderCorner;

/* The corners of a figure that a declaration knows, found when the figure is joined; before that none. */
typedef struct Border {
    BorderCorner *corners;
    uint32_t      count;
    bool          found;
} Border;

struct Shape {
    ShapeKind     kind;
    Span          span;  /* of the expression that made it */
    const char   *name;  /* of the declaration or operation, for dumps */
    const char   *given; /* what the author calls it: by the `let` that has it first; or NULL */
    const Shape **children;
    uint32_t      child_count;
    uint32_t      depth;       /* of the tree below, at most MAX_SHAPE_DEPTH */
    uint32_t      tree_shapes; /* of that tree and itself, each where it is used; MAX_TREE_SHAPES */

    uint32_t shown;   /* number from 1 of the component that it is, where it has been gathered with
                       others; else 0 */
    Box      box;     /* around the solid, for all values of the parameters: by box_rules.h */
    double   slope;   /* Lipschitz constant of what it lowers to */
    double   derived; /* PRIMITIVE: the slope of its expression, by which it is divided; else the
                       largest in the tree */
    bool     exact;   /* the distance outside is the true one */
    bool     curved_child; /* shape_is_curved of a child */
    bool     claimed;      /* PRIMITIVE: its slope is claimed, not derived */
    bool     estimate;  /* nothing is proven of the distance: a primitive in it is measured only */
    bool     per_frame; /* in the tree is a slope that is found anew for each state (StateSlope) */
    bool     trapped;   /* in the tree is a fractal or a mirror: `orbit_trap` means something */
    bool     figure;    /* a plane figure in x and y */
    bool     nothing;   /* made of empty unions alone: a figure as well as a solid */
    bool     open;      /* SHELL: an open surface, with two sides, whatever its thickness */
    bool open_surface; /* SHELL: has no thickness where rays can go from root to root (rays_pass) */
    bool open_surfaces;  /* in the tree are some */
    bool fields;         /* in the tree is a field whose bound follows from a region */
    bool fronts;         /* PAINT: its material asks for `front` */
    bool smooth;         /* something in the tree turns normals: smooth mirrors, bumps */
    double   instances;  /* copies of kernels that reflections make; 1 without a sequence */
    uint32_t levels;     /* reflections of the outermost sequence in it */
    uint32_t inversions; /* maps of that sequence that invert, or of `.transform` on the way */

    /* PRIMITIVE, in its own coordinates; bound, uv and trap (VEC2) may be NODE_NONE. */
    Node   formula;  /* of a field, algebraic surface (field.c) or DISPLACE, else NODE_NONE */
    Node   declared; /* where a declaration made it: its `distance` as it is written */
    double overlap;  /* BEND: by how much the segments reach beyond their ends */
    double reach;    /* DISPLACE: largest size of the formula in the box; OFFSET, SHELL: how far
                         they take the surface, at most */
    double divided;  /* DISPLACE, TWIST, TAPER, BEND: what distances are divided by, at most */
    double moved;    /* DISPLACE: how far the surface moves, at most */
    const FieldFacts *field; /* zeros where there is nothing to know; never NULL */
    /* PRIMITIVE of a declaration: its box is that of the ball, or of a shape, or has two corners,
       the least and the greatest; NODE_NONE: it stands in `box`. */
    bool                ball_box;
    const struct Shape *within;
    Node                corners[2];
    Node                distance, bound, uv, trap;
    const struct Shape *without_uv; /* a primitive in the tree that has none, or NULL */
    Node                values[2];  /* see ShapeKind; NODE_NONE where there are fewer */
    Map                 map;        /* without `first`; of kinds that have none its scale is
                                       NODE_NONE */
    Blend               blend;      /* of CSG nodes */
    FalloffKind         falloff;    /* META */
    uint32_t            cells[3];   /* REPEAT: copies per axis, 0 for endless */
    uint32_t            stage_count;

    struct OutlineShape *outline; /* PRIMITIVE that contours fill (lower/outline.h), else NULL */
    Border              *border;  /* PRIMITIVE whose declaration knows its outline, else NULL */
    struct Boundary *boundary; /* what lower/boundary.h makes of a CSG node or REVOLVE, else NULL */
    Node plane_normal, plane_offset; /* PRIMITIVE that is a half-space, else NODE_NONE */
    Node ball_radius;                /* PRIMITIVE that is a ball about the origin, else NODE_NONE */
    /* PRIMITIVE that a declaration of the language made: what the evaluator knows of it, and
       shapes do not; else NULL. */
    const struct Declaration *declaration;
    /* ITERATION: what all iterations of a loop have in common, which is no child: numbers in it depend on
       the leaf `iteration`, which is `number` in this one; and what the evaluator knows of the loop.  Else
       NULL and NODE_NONE. */
    const struct Shape           *iterated;
    Node                          iteration;
    double                        number;
    const struct IterationSource *source;

    const struct Shape  *rounded; /* OFFSET that .round made of a core: what is rounded; or NULL */
    const Material      *material;
    const SequenceStage *stages;
    const LevelBound    *bounds; /* of the stages, for all values of the parameters */
};

/* Returns an iteration as what it is an iteration of; any other shape as it is: for what does not
   ask for numbers. */
static inline const Shape *shape_in_iterations(const Shape *shape)
{
    return shape->iterated ? shape->iterated : shape;
}

/* Tells whether it is curved nearly everywhere, or finer than a pixel as a rule, so that where its normal
   turns there need be no edge: blends, sequences, fields, and what is bent or stretched. */
bool shape_is_curved(const Shape *shape);

#endif
