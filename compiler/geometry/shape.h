/*
 * shape.h: the elaborated scene: trees of shapes, and what the picture needs beside them.
 *
 * A shape is made by the functions below, bottom up; each knows at once its bounding box and
 * how steep its distance is, by the rule of its kind.  Numbers in it are nodes of the graph
 * that do not depend on the point, so a parameter can move everything.  Shapes never change.
 */
#ifndef KRS_SHAPE_H
#define KRS_SHAPE_H

#include "compiler/geometry/box.h"
#include "compiler/geometry/value.h"
#include "compiler/graph/zeros.h"

/*
 * Kinds, with their children and values (nodes).  `slope` says how the Lipschitz constant of
 * the result follows from that of the children (math.md, section 4).
 */
typedef enum ShapeKind {
    SHAPE_EMPTY,        /* nothing: distance infinite */
    SHAPE_PRIMITIVE,    /* `distance`, `bound`; slope 1 after division by the derived one */
    SHAPE_TRANSFORM,    /* [0]; map; distances times its scale; slope of the child */
    SHAPE_INVERSION,    /* [0]; map with a pole; distances by the bound of lower_moebius.c; slope
                           of the child */
    SHAPE_STRETCH,      /* [0]; values[0] factors (VEC3); times the least; slope of the child */
    SHAPE_UNION,        /* [..]; blend; largest slope times the blend's factor */
    SHAPE_INTERSECTION, /* likewise */
    SHAPE_DIFFERENCE,   /* [0] less all others; likewise */
    SHAPE_XOR,          /* [0], [1]; likewise */
    SHAPE_MORPH,        /* [0], [1]; values[0] in [0, 1]; largest slope */
    SHAPE_META,     /* [..]; values[0] level, values[1] reach; largest slope: see metasurface.c */
    SHAPE_OFFSET,   /* [0]; values[0]; d - r; slope of the child */
    SHAPE_SHELL,    /* [0]; values[0]; |d| - t / 2; slope of the child */
    SHAPE_ELONGATE, /* [0]; values[0] half lengths; slope of the child (a clamp's is 1) */
    SHAPE_EXTRUDE,  /* [0] a figure; values[0] half height; largest of child's and 1 */
    SHAPE_REVOLVE,  /* [0] a figure; values[0] offset; slope of the child */
    SHAPE_REPEAT,   /* [0]; values[0] period, cells; slope of the child: see lower_repeat.c */
    SHAPE_REPEAT_POLAR, /* [0]; cells[0] copies about y; slope of the child */
    SHAPE_MIRROR,       /* [0]; values[0] unit normal, values[1] offset; slope of the child */
    SHAPE_TWIST,        /* [0]; values[0] rate, about y; 1: see lower_deform.c, also for the next */
    SHAPE_BEND,         /* [0]; values[0] rate, about x; cells[0] segments, which overlap; 1 */
    SHAPE_TAPER,        /* [0]; values[0], values[1] factors at both ends of y; 1 */
    SHAPE_DISPLACE,     /* [0]; values[0] amplitude of `formula`, values[1] its slope; 1 */
    SHAPE_SMOOTH,       /* [0]; values[0] width or NODE_NONE; slope of the child */
    SHAPE_PAINT,        /* [0]; material; slope of the child */
    SHAPE_KRS           /* kernels; stages in order; the largest slope: folds are 1-Lipschitz */
} ShapeKind;

/*
 * A conformal map of space: the similarity x -> scale * rows * x + shift or, with a pole,
 * x -> scale * rows * (x - pole) / |x - pole|^2 + shift; rows orthonormal, scale > 0.  Products
 * are one map again, except of inversions whose poles may come too near to each other: those
 * stay apart, and `first` is what is applied before.
 */
struct Map {
    Node       scale, rows[3], shift;
    Node       pole;  /* NODE_NONE: a similarity */
    const Map *first; /* NULL: nothing; similarities have none */
};

/* The rows of the inverse of a turn. */
void transpose_rows(Graph *graph, const Node rows[3], Node transposed[3]);

/* How two distances are joined; blends.def has a row for each. */
typedef enum BlendKind {
#define BLEND(name, spelling, op, slope, bulge, meaning) BLEND_##name,
#include "compiler/geometry/blends.def"
#undef BLEND
    BLEND_COUNT
} BlendKind;

typedef struct BlendInfo {
    const char *spelling;
    Op          op;    /* smooth minimum of (a, b, width) */
    double      slope; /* slope of the result over the larger slope of the operands */
    double      bulge; /* how far min(a, b) may exceed the result, in widths */
} BlendInfo;
extern const BlendInfo blend_info[BLEND_COUNT];

/* How the shapes of a metasurface fade; falloffs.def has a row for each. */
typedef enum FalloffKind {
#define FALLOFF(name, spelling, steepest, meaning) FALLOFF_##name,
#include "compiler/geometry/falloffs.def"
#undef FALLOFF
    FALLOFF_COUNT
} FalloffKind;

typedef struct Blend {
    BlendKind kind;
    Node      width; /* NODE_NONE: the joint is sharp */
    Node      steps; /* of BLEND_STAIRS */
} Blend;
extern const Blend blend_sharp;

/* One statement of a `krs` block. */
typedef struct SequenceStage {
    enum { SEQUENCE_KERNEL, SEQUENCE_REFLECT, SEQUENCE_MAP } kind;
    uint32_t kernel;         /* KERNEL: index of the child */
    Node     normal, offset; /* REFLECT: unit normal and offset */
    Map      map;            /* MAP, without `first` */
    Span     span;
} SequenceStage;

/* Around all that the stages of a sequence up to one have made, where that one leaves it. */
typedef struct LevelBound {
    Box  box;
    Ball ball; /* may be the tighter of the two */
} LevelBound;

/* Each is about a quarter turn. */
enum { MOST_BEND_SEGMENTS = 16 };

/* Walks of the tree are recursive. */
enum { MOST_SHAPE_DEPTH = 1000 };
/* Walks visit a shape as often as it is used, which is more often than there are shapes. */
enum { MOST_TREE_SHAPES = 100000 };

struct Shape {
    ShapeKind     kind;
    Span          span; /* of the expression that made it */
    const char   *name; /* of the declaration or operation, for dumps */
    const Shape **children;
    uint32_t      child_count;
    uint32_t      depth;  /* of the tree below, at most MOST_SHAPE_DEPTH */
    uint32_t tree_shapes; /* of that tree and itself, each where it is used; MOST_TREE_SHAPES */

    Box      box;     /* around the solid, for all values of the parameters */
    double   slope;   /* Lipschitz constant of what it lowers to */
    double   derived; /* PRIMITIVE: the slope of its expression, by which it is divided; else the
                       largest in the tree */
    bool     exact;   /* the distance outside is the true one */
    bool     curved_child; /* shape_is_curved of a child */
    bool     claimed;      /* PRIMITIVE: its slope is claimed, not derived */
    Box      region;    /* PRIMITIVE: over which its slope was derived; infinite: over all space */
    bool     estimate;  /* nothing is proven of the distance: a primitive in it is measured only */
    bool     per_frame; /* in the tree is a slope that is found anew for each frame (FrameSlope) */
    bool     trapped;   /* in the tree is a fractal: `orbit_trap` means something */
    bool     figure;    /* a plane figure in x and y */
    bool     sheet;  /* SHELL: has no thickness where rays can go from root to root (rays_pass) */
    bool     sheets; /* in the tree are some */
    double   instances;  /* copies of kernels that reflections make; 1 without a sequence */
    uint32_t levels;     /* reflections of the outermost sequence in it */
    uint32_t inversions; /* maps of that sequence that invert, or of `.transform` on the way */

    /* PRIMITIVE, in its own coordinates; bound, uv and trap (VEC2) may be NODE_NONE. */
    Node     formula; /* of a field, algebraic surface (field.c) or DISPLACE, else NODE_NONE */
    double   overlap; /* BEND: by how much the segments reach beyond their ends */
    double   reach;   /* DISPLACE: largest size of the formula in the box */
    uint32_t degree;  /* of a formula that is a polynomial, else 0, */
    ZeroBox  zeros;   /* and where that may be 0 */
    Span     blame;   /* what a field without a bound owes that to */
    bool     fields;  /* in the tree is a field whose bound follows from a region */
    Node     distance, bound, uv, trap;
    const struct Shape *without_uv; /* a primitive in the tree that has none, or NULL */
    bool                smooth;     /* mirrors in the tree are smooth */
    Node                values[2];  /* see ShapeKind; NODE_NONE where there are fewer */
    Map                 map;        /* without `first` */
    Blend               blend;      /* of joints */
    FalloffKind         falloff;    /* META */
    uint32_t            cells[3];   /* REPEAT: copies per axis, 0 for endless */

    Node          plane_normal, plane_offset; /* PRIMITIVE that is a half-space, else NODE_NONE */
    const Syntax *declaration;                /* PRIMITIVE that a declaration made, else NULL */
    Node          declared;      /* of such a primitive: its `distance` as it is written */
    const struct Shape *rounded; /* OFFSET that .round made of a core: what is rounded; or NULL */
    const Syntax       *core; /* PRIMITIVE: what .round(r) grows by r, using `rounding`; or NULL */
    const struct Environment *core_names; /* what that expression sees */
    const Material           *material;
    const SequenceStage      *stages;
    uint32_t                  stage_count;
    const LevelBound         *bounds; /* of the stages, for all values of the parameters */
};

/* A `param`: its slot in the parameter block and its range. */
typedef struct Parameter {
    const char *name;
    uint32_t    slot, components;
    double      value[4], low[4], high[4];
} Parameter;

/* What a `show` shows. */
typedef struct Component {
    const char  *name;
    const Shape *shape;
    Span         span;
    Node         plane_normal, plane_offset; /* of a half-space and nothing else, or NODE_NONE */
} Component;

/* Numbers and vectors here are frame-time nodes. */
typedef struct SceneCamera {
    const char *name; /* or NULL */
    Node        eye, target, up, fov, height;
    uint32_t    projection;
    bool        standing_in; /* for a scene that has no camera: framing.c finds eye and target */
} SceneCamera;

typedef struct SceneLight {
    bool positional, shadow;
    Node vector, color, softness;
} SceneLight;

typedef struct SceneImage {
    uint32_t    width, height, samples;
    const char *integrator, *tone_map;
    double      exposure, error;
} SceneImage;

/* The slope of an expression that no constant bounds, as parameters in it have no limits: it is
   found for the values of each frame (slope.c), and stands in a slot of the parameter block. */
typedef struct FrameSlope {
    uint32_t slot;
    Node     formula;
    Box      region; /* over which it is found; infinite: all space */
    Span     span;   /* of the formula */
} FrameSlope;

/* The slot has a number of single precision that is no less than the slope; infinite: there is no
   bound. */
double frame_slope_upward(double slope);
/* Into how many cells the region is cut at most. */
uint32_t frame_slope_cells(Box region);

/* The host finds each anew whenever anything changes. */
enum { MOST_FRAME_SLOPES = 256 };

typedef struct Scene {
    Graph *graph;
    struct {
        Component *items;
        size_t     count, capacity;
    } components;
    struct {
        Parameter *items;
        size_t     count, capacity;
    } parameters;
    struct {
        FrameSlope *items;
        size_t      count, capacity;
    } slopes;
    /* Declared half-spaces, which may be in no component: mirrors. */
    struct {
        const Shape **items;
        size_t        count, capacity;
    } half_spaces;
    struct {
        SceneCamera *items;
        size_t       count, capacity;
    } cameras;
    struct {
        SceneLight *items;
        size_t      count, capacity;
    } lights;
    Node       zenith, horizon, ground;
    Node       zone; /* the depth of OP_POINT in zones, negative outside; NODE_NONE without any */
    size_t     zone_count;
    SceneImage image;
    Box        box; /* around all components */
} Scene;

/* Whether it is curved nearly everywhere, or finer than a pixel as a rule, so that where its normal
   turns there need be no edge: blends, sequences, fields, and what is bent or stretched. */
bool shape_is_curved(const Shape *shape);

/* The scene as indented text, for `krs dump --after=scene`. */
void scene_print(const Scene *scene, const Sources *sources, Text *out);

#endif
